// Streams through the C ABI. What they send is tested where streaming is; here: the way from the functions to the
// channels.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include "host.hpp"

namespace koppel::test {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

class Streams : public ::testing::Test {
 protected:
  koppel_status open(const std::string& url, const char* name = nullptr, double period = 0.0) {
    auto options = sized<koppel_stream_options>();
    options.url = url.c_str();
    options.name = name;
    options.period = period;
    stream.value = nullptr;
    return koppel_stream_open(host.mechanism.get(), &options, &stream, &error);
  }

  Host host{"rstr"};
  Output<koppel_stream*> stream;
  koppel_error error = sized<koppel_error>();
  koppel_stream_statistics statistics = sized<koppel_stream_statistics>();
};

TEST_F(Streams, IntoALogLoseNothing) {
  const auto file = std::filesystem::temp_directory_path() / ("koppel_abi_" + std::to_string(getpid()) + ".lcm");
  ASSERT_EQ(open("file://" + file.string() + "?mode=w"), KOPPEL_OK) << error.message;
  auto report = sized<koppel_report>();
  constexpr int steps = 50;
  for (int i = 0; i < steps; ++i) {
    ASSERT_GE(koppel_move(host.state.get(), host.work.get(), 0.01 * i, &report, nullptr), KOPPEL_OK);
    ASSERT_EQ(koppel_stream_publish(stream.value, host.state.get(), host.work.get(), &report), KOPPEL_OK);
  }
  ASSERT_EQ(koppel_stream_event(stream.value, 0.5, KOPPEL_SEVERITY_WARNING, "half way"), KOPPEL_OK);
  ASSERT_EQ(koppel_stream_close(stream.value, &statistics), KOPPEL_OK);
  EXPECT_EQ(statistics.published, std::uint64_t{steps});
  EXPECT_EQ(statistics.sent, std::uint64_t{steps});
  EXPECT_EQ(statistics.dropped + statistics.failed, 0u);
  const std::string log = bytes_of(file);
  EXPECT_EQ(occurrences(log, "KOPPEL_RSTR_STATE"), std::size_t{steps});
  EXPECT_EQ(occurrences(log, "KOPPEL_RSTR_POSES"), std::size_t{steps});
  EXPECT_EQ(occurrences(log, "KOPPEL_RSTR_CLOSURE"), std::size_t{steps});
  EXPECT_GE(occurrences(log, "KOPPEL_RSTR_MODEL"), 1u);
  EXPECT_EQ(occurrences(log, "half way"), 1u);
  std::filesystem::remove(file);
}

TEST_F(Streams, IntoMemoryCountWhatTheyGot) {
  ASSERT_EQ(open("memq://", "OWN_NAME"), KOPPEL_OK) << error.message;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(koppel_stream_publish(stream.value, host.state.get(), host.work.get(), nullptr), KOPPEL_OK);
  }
  ASSERT_EQ(koppel_stream_close(stream.value, &statistics), KOPPEL_OK);
  EXPECT_EQ(statistics.published, 20u);
  EXPECT_EQ(statistics.sent + statistics.dropped, 20u);
  EXPECT_EQ(statistics.failed, 0u);
}

TEST_F(Streams, TakeStatesOfTheirMechanismOnly) {
  ASSERT_EQ(open("memq://"), KOPPEL_OK);
  const Mechanism twin = compile(host.scene.get());
  const State other = make_state(twin);
  const Work scratch = make_work(twin);
  EXPECT_EQ(koppel_stream_publish(stream.value, other.get(), scratch.get(), nullptr), KOPPEL_INVALID_ARGUMENT);
  EXPECT_EQ(koppel_stream_publish(stream.value, host.state.get(), scratch.get(), nullptr), KOPPEL_INVALID_ARGUMENT);
  ASSERT_EQ(koppel_stream_close(stream.value, &statistics), KOPPEL_OK);
  EXPECT_EQ(statistics.published, 0u);
}

TEST_F(Streams, WithABadUrlNameOrPeriodAreRefused) {
  for (const char* url : {"carrier-pigeon://", "no url", "file://", "memq://somewhere", "udpm://1.2.3.4:5"}) {
    EXPECT_EQ(open(url), KOPPEL_INVALID_ARGUMENT) << url;
    EXPECT_STREQ(error.code, "E0801") << url;
    EXPECT_STRNE(error.advice, "") << url;
  }
  EXPECT_EQ(open("file:///nowhere/at/all.lcm?mode=w"), KOPPEL_IO);
  EXPECT_STREQ(error.code, "E0802");
  EXPECT_EQ(open("memq://", "a name"), KOPPEL_INVALID_ARGUMENT);
  EXPECT_STREQ(error.code, "E0803");
  EXPECT_EQ(open("memq://", nullptr, -1.0), KOPPEL_INVALID_ARGUMENT);
  EXPECT_EQ(stream.value, nullptr);
}

}  // namespace
}  // namespace koppel::test
