// Assembly modes and the solution flow through the C ABI: what is found, who owns it, how a search is stopped.
#include <cmath>
#include <set>

#include "folders.hpp"
#include "host.hpp"

namespace koppel::test {
namespace {

constexpr koppel_status refused = KOPPEL_INVALID_ARGUMENT;

Modes find(const Host& host, const koppel_modes_options* options = nullptr) {
  koppel_modes* found = nullptr;
  EXPECT_EQ(koppel_modes_find(host.state.get(), host.work.get(), options, &found, nullptr), KOPPEL_OK);
  return Modes(found);
}

koppel_modes_summary summary_of(const Modes& modes) {
  auto summary = sized<koppel_modes_summary>();
  EXPECT_EQ(koppel_modes_summarise(modes.get(), &summary), KOPPEL_OK);
  return summary;
}

std::string id_of(const Modes& modes, std::size_t i) {
  return text_of([&](char* text, std::size_t size, std::size_t* needed) {
    return koppel_modes_id(modes.get(), i, text, size, needed);
  });
}

std::string flow_of(const Host& host, std::int32_t format) {
  return text_of([&](char* text, std::size_t size, std::size_t* needed) {
    return koppel_flow_explain(host.mechanism.get(), format, text, size, needed);
  });
}

TEST(Modes, AreAllFoundAndClose) {
  for (const auto& [name, count] :
       {std::pair{"rstr", 4u}, std::pair{"rscr", 2u}, std::pair{"rccc", 2u}, std::pair{"4bar", 2u}}) {
    const Host host(name);
    const Modes modes = find(host);
    const koppel_modes_summary summary = summary_of(modes);
    EXPECT_EQ(summary.count, count) << name;
    EXPECT_EQ(summary.complete, 1) << name;
    EXPECT_EQ(summary.twins, 1u) << name;
    EXPECT_EQ(summary.missed_by, 0.0) << name;
    std::set<std::string> ids;
    for (std::size_t i = 0; i < summary.count; ++i) {
      auto mode = sized<koppel_mode>();
      ASSERT_EQ(koppel_modes_get(modes.get(), i, &mode), KOPPEL_OK);
      EXPECT_LT(mode.residual, 1e-13);
      EXPECT_EQ(mode.limit, 0);
      ids.insert(id_of(modes, i));
      ASSERT_EQ(koppel_modes_take(modes.get(), i, host.state.get()), KOPPEL_OK);
      const Reading taken = read(host);
      auto report = sized<koppel_report>();
      ASSERT_GE(koppel_close(host.state.get(), host.work.get(), nullptr, &report, nullptr), KOPPEL_OK);
      EXPECT_LT(report.residual, 1e-13);
      const Reading closed = read(host);
      for (std::size_t k = 0; k < taken.q.size(); ++k) EXPECT_NEAR(closed.q[k], taken.q[k], 1e-12) << name;
    }
    EXPECT_EQ(ids.size(), count) << name;
  }
}

TEST(Modes, LeaveTheStateAlone) {
  const Host host("rstr");
  const Reading before = read(host);
  find(host);
  EXPECT_TRUE(read(host) == before);
}

TEST(Modes, OfLinksThatTurnOverAreListedOnDemand) {
  const Host host("swash");
  EXPECT_EQ(summary_of(find(host)).count, 4u);
  EXPECT_EQ(summary_of(find(host)).twins, 4u);
  auto options = sized<koppel_modes_options>();
  options.all_twins = 1;
  EXPECT_EQ(summary_of(find(host, &options)).count, 16u);
  EXPECT_EQ(summary_of(find(host, &options)).twins, 1u);
}

TEST(Modes, OfAnOpenChainAreOne) {
  const Host host("6r");
  const koppel_modes_summary summary = summary_of(find(host));
  EXPECT_EQ(summary.count, 1u);
  EXPECT_EQ(summary.complete, 1);
}

TEST(Modes, ThatAreNotThereAreNoFailure) {
  const Host host(tests_folder() + "/abi/out_of_reach.toml");
  ASSERT_EQ(koppel_state_set_time(host.state.get(), 0.25, nullptr), KOPPEL_OK);
  const Modes modes = find(host);
  EXPECT_EQ(summary_of(modes).count, 0u);
  EXPECT_EQ(summary_of(modes).complete, 1);
  EXPECT_GT(summary_of(modes).missed_by, 0.0);
  EXPECT_EQ(koppel_modes_take(modes.get(), 0, host.state.get()), refused);
}

TEST(Modes, AreStoppedByTheHost) {
  const Host host("rstr");
  auto options = sized<koppel_modes_options>();
  std::size_t seen = 0;
  options.user = &seen;
  options.progress = [](std::size_t found, double, void* user) -> std::int32_t {
    *static_cast<std::size_t*>(user) = found;
    return found == 2 ? 1 : 0;
  };
  const koppel_modes_summary summary = summary_of(find(host, &options));
  EXPECT_EQ(seen, 2u);
  EXPECT_EQ(summary.count, 2u);
  EXPECT_EQ(summary.complete, 0);
}

TEST(Modes, OutliveWhatTheyWereMadeFrom) {
  Host host("rstr");
  const Modes modes = find(host);
  host.work.reset();
  host.scene.reset();
  host.engine.reset();
  host.mechanism.reset();
  EXPECT_EQ(koppel_modes_take(modes.get(), 3, host.state.get()), KOPPEL_OK);
  host.state.reset();
  EXPECT_EQ(summary_of(modes).count, 4u);
  EXPECT_NE(id_of(modes, 3), "");
}

TEST(Modes, OfAnotherMechanismOrOutOfRangeAreRefused) {
  const Host host("rstr"), stranger("rstr");
  const Modes modes = find(host);
  koppel_modes* none = nullptr;
  EXPECT_EQ(koppel_modes_find(host.state.get(), stranger.work.get(), nullptr, &none, nullptr), refused);
  EXPECT_EQ(none, nullptr);
  const Reading before = read(stranger);
  EXPECT_EQ(koppel_modes_take(modes.get(), 0, stranger.state.get()), refused);
  EXPECT_TRUE(read(stranger) == before);
  auto mode = sized<koppel_mode>();
  EXPECT_EQ(koppel_modes_get(modes.get(), 4, &mode), refused);
  char text[8] = "before";
  EXPECT_EQ(koppel_modes_id(modes.get(), 4, text, sizeof text, nullptr), refused);
  EXPECT_STREQ(text, "before");
}

TEST(Flow, IsToldInTextAndAsAGraph) {
  const Host host("swash");
  EXPECT_NE(flow_of(host, KOPPEL_FLOW_TEXT).find("Every step is in closed form"), std::string::npos);
  EXPECT_EQ(flow_of(host, KOPPEL_FLOW_DOT).rfind("digraph", 0), 0u);
  EXPECT_EQ(flow_of(host, KOPPEL_FLOW_DOT), flow_of(host, KOPPEL_FLOW_DOT));
  for (const std::int32_t format : {-1, 2}) EXPECT_EQ(flow_of(host, format), "");
}

}  // namespace
}  // namespace koppel::test
