// Arguments that are no pointers but wrong all the same: counts, indices, kinds, strangers' handles, numbers that are
// not finite. The status says so and nothing was written.
#include <cmath>
#include <cstdint>
#include <limits>

#include "host.hpp"

namespace koppel::test {
namespace {

constexpr koppel_status refused = KOPPEL_INVALID_ARGUMENT;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

class Arguments : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_GE(host.move(0.0), KOPPEL_OK); }

  /// Room for any output here, to see that nothing is written.
  std::vector<double> out = std::vector<double>(1024, -7.0);
  bool untouched() const { return out == std::vector<double>(1024, -7.0); }

  Host host{"rstr"};
  koppel_mechanism* mechanism = host.mechanism.get();
  koppel_state* state = host.state.get();
  koppel_work* work = host.work.get();
  const std::size_t bodies = host.sizes.bodies, rates = host.sizes.rates, coordinates = host.sizes.coordinates;
};

TEST_F(Arguments, CountsThatDoNotFitAreRefused) {
  for (const std::ptrdiff_t off : {-1, 1}) {
    const auto wrong = [off](std::size_t right) { return right + static_cast<std::size_t>(off); };
    EXPECT_EQ(koppel_state_get(state, KOPPEL_Q, out.data(), wrong(coordinates)), refused);
    EXPECT_EQ(koppel_state_get(state, KOPPEL_V, out.data(), wrong(rates)), refused);
    EXPECT_EQ(koppel_state_get(state, KOPPEL_A, out.data(), wrong(rates)), refused);
    EXPECT_EQ(koppel_state_set(state, KOPPEL_Q, out.data(), wrong(coordinates)), refused);
    EXPECT_EQ(koppel_state_set(state, KOPPEL_V, out.data(), wrong(rates)), refused);
    EXPECT_EQ(koppel_state_set(state, KOPPEL_A, out.data(), wrong(rates)), refused);
    EXPECT_EQ(koppel_poses(state, work, KOPPEL_KIND_BODY, out.data(), wrong(12 * bodies)), refused);
    EXPECT_EQ(koppel_twists(state, work, KOPPEL_KIND_BODY, out.data(), wrong(6 * bodies)), refused);
    EXPECT_EQ(koppel_frame_accelerations(state, work, KOPPEL_KIND_BODY, out.data(), wrong(6 * bodies)), refused);
    EXPECT_EQ(koppel_jacobian(state, work, KOPPEL_KIND_BODY, 1, out.data(), nullptr, wrong(6 * rates)), refused);
    EXPECT_EQ(koppel_records(state, work, out.data(), wrong(host.sizes.records)), refused);
  }
  EXPECT_TRUE(untouched());
}

TEST_F(Arguments, APathHasTheLengthThatTheClosureTells) {
  auto closure = sized<koppel_closure>();
  ASSERT_EQ(koppel_mechanism_closure(mechanism, 0, &closure, nullptr, 0), KOPPEL_OK);
  std::vector<std::uint32_t> path(closure.path + 1, 99u);
  Output<koppel_closure> second;
  second.value.struct_size = sizeof(koppel_closure);
  const koppel_closure before = second.value;
  EXPECT_EQ(koppel_mechanism_closure(mechanism, 0, &second, path.data(), path.size()), refused);
  EXPECT_EQ(std::memcmp(&before, &second.value, sizeof before), 0);
  EXPECT_EQ(path, std::vector<std::uint32_t>(path.size(), 99u));
  EXPECT_EQ(koppel_mechanism_closure(mechanism, 0, &second, path.data(), closure.path), KOPPEL_OK);
  EXPECT_EQ(path.back(), 99u);
}

TEST_F(Arguments, IndicesOutOfRangeAreRefused) {
  auto closure = sized<koppel_closure>();
  auto inertia = sized<koppel_inertia>();
  std::size_t needed = 77;
  for (const std::size_t far : {std::size_t{host.sizes.coordinates}, SIZE_MAX / 2, SIZE_MAX}) {
    EXPECT_EQ(koppel_mechanism_closure(mechanism, far, &closure, nullptr, 0), refused) << far;
    EXPECT_EQ(koppel_body_inertia(mechanism, far, &inertia, nullptr), refused) << far;
    EXPECT_EQ(koppel_jacobian(state, work, KOPPEL_KIND_BODY, far, out.data(), nullptr, 6 * rates), refused) << far;
    EXPECT_EQ(koppel_state_set_input(state, far, 0.0, 0.0, 0.0), refused) << far;
    for (std::int32_t kind = KOPPEL_KIND_BODY; kind <= KOPPEL_KIND_SCENE; ++kind) {
      if (kind == KOPPEL_KIND_RECORD && far < host.sizes.records) continue;
      EXPECT_EQ(koppel_mechanism_name(mechanism, kind, far, nullptr, 0, &needed), refused) << kind << " " << far;
      EXPECT_EQ(koppel_mechanism_unit(mechanism, kind, far, nullptr, 0, &needed), refused) << kind << " " << far;
    }
  }
  EXPECT_EQ(needed, 77u);
  EXPECT_TRUE(untouched());
}

TEST_F(Arguments, KindsThatDoNotExistAreRefused) {
  std::size_t needed = 77, index = 77;
  for (const std::int32_t kind : {0, -1, 10, INT32_MAX, INT32_MIN}) {
    EXPECT_EQ(koppel_mechanism_name(mechanism, kind, 0, nullptr, 0, &needed), refused) << kind;
    EXPECT_EQ(koppel_mechanism_unit(mechanism, kind, 0, nullptr, 0, &needed), refused) << kind;
    EXPECT_EQ(koppel_mechanism_find(mechanism, kind, "crank", &index, nullptr), refused) << kind;
    EXPECT_EQ(koppel_state_get(state, kind, out.data(), coordinates), refused) << kind;
    EXPECT_EQ(koppel_state_set(state, kind, out.data(), coordinates), refused) << kind;
    EXPECT_EQ(koppel_poses(state, work, kind, out.data(), 12 * bodies), refused) << kind;
    EXPECT_EQ(koppel_jacobian(state, work, kind, 0, out.data(), nullptr, 6 * rates), refused) << kind;
  }
  // Poses are of bodies and frames; this scene has no frames.
  EXPECT_EQ(koppel_poses(state, work, KOPPEL_KIND_JOINT, out.data(), 12 * bodies), refused);
  EXPECT_EQ(koppel_poses(state, work, KOPPEL_KIND_FRAME, out.data(), 12 * bodies), refused);
  EXPECT_EQ(needed, 77u);
  EXPECT_EQ(index, 77u);
  EXPECT_TRUE(untouched());
}

TEST_F(Arguments, HandlesOfAnotherMechanismAreRefused) {
  const Mechanism twin = compile(host.scene.get());
  const State other_state = make_state(twin);
  const Work other_work = make_work(twin);
  auto analysis = sized<koppel_analysis>();
  const Reading before = read(host);
  EXPECT_EQ(koppel_state_copy(other_state.get(), state), refused);
  EXPECT_EQ(koppel_close(state, other_work.get(), nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_velocities(state, other_work.get(), nullptr), refused);
  EXPECT_EQ(koppel_accelerations(state, other_work.get(), nullptr), refused);
  EXPECT_EQ(koppel_move(state, other_work.get(), 0.1, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_analyse(state, other_work.get(), &analysis, nullptr), refused);
  auto freedoms = sized<koppel_freedoms>();
  char text[16];
  EXPECT_EQ(koppel_find_freedoms(state, other_work.get(), &freedoms, nullptr), refused);
  EXPECT_EQ(koppel_explain_freedoms(state, other_work.get(), text, sizeof text, nullptr), refused);
  // Another: a state that was never closed has no position whose freedoms could be told.
  EXPECT_EQ(koppel_find_freedoms(other_state.get(), other_work.get(), &freedoms, nullptr), refused);
  EXPECT_EQ(koppel_poses(state, other_work.get(), KOPPEL_KIND_BODY, out.data(), 12 * bodies), refused);
  EXPECT_EQ(koppel_twists(state, other_work.get(), KOPPEL_KIND_BODY, out.data(), 6 * bodies), refused);
  EXPECT_EQ(koppel_frame_accelerations(state, other_work.get(), KOPPEL_KIND_BODY, out.data(), 6 * bodies), refused);
  EXPECT_EQ(koppel_jacobian(state, other_work.get(), KOPPEL_KIND_BODY, 1, out.data(), nullptr, 6 * rates), refused);
  EXPECT_EQ(koppel_records(state, other_work.get(), out.data(), host.sizes.records), refused);
  EXPECT_TRUE(untouched());
  EXPECT_TRUE(read(host) == before);
}

TEST_F(Arguments, NumbersThatAreNotFiniteAreRefused) {
  const Reading before = read(host);
  for (const double bad : {nan, infinity, -infinity}) {
    std::vector<double> q = before.q, v = before.v;
    q.back() = bad;
    v.front() = bad;
    EXPECT_EQ(koppel_state_set(state, KOPPEL_Q, q.data(), q.size()), refused);
    EXPECT_EQ(koppel_state_set(state, KOPPEL_V, v.data(), v.size()), refused);
    EXPECT_EQ(koppel_state_set(state, KOPPEL_A, v.data(), v.size()), refused);
    EXPECT_EQ(koppel_state_set_time(state, bad, nullptr), refused);
    EXPECT_EQ(koppel_state_set_input(state, 0, bad, 0.0, 0.0), refused);
    EXPECT_EQ(koppel_state_set_input(state, 0, 0.0, bad, 0.0), refused);
    EXPECT_EQ(koppel_state_set_input(state, 0, 0.0, 0.0, bad), refused);
    EXPECT_EQ(koppel_move(state, work, bad, nullptr, nullptr), refused);
    auto options = sized<koppel_close_options>();
    options.tolerance = bad;
    EXPECT_EQ(koppel_close(state, work, &options, nullptr, nullptr), refused);
  }
  EXPECT_TRUE(read(host) == before);
}

TEST_F(Arguments, OptionsOfAClosureAreChecked) {
  const Reading before = read(host);
  auto options = sized<koppel_close_options>();
  options.method = KOPPEL_METHOD_FLOW + 1;
  auto error = sized<koppel_error>();
  EXPECT_EQ(koppel_close(state, work, &options, nullptr, &error), refused);
  EXPECT_STREQ(error.code, "E0901");
  options.method = -1;
  EXPECT_EQ(koppel_close(state, work, &options, nullptr, nullptr), refused);
  options = sized<koppel_close_options>();
  options.tolerance = -1e-9;
  EXPECT_EQ(koppel_close(state, work, &options, nullptr, nullptr), refused);
  options = sized<koppel_close_options>();
  options.max_iterations = UINT32_MAX;
  EXPECT_EQ(koppel_close(state, work, &options, nullptr, nullptr), refused);
  EXPECT_TRUE(read(host) == before);
}

TEST_F(Arguments, HugeNumbersNeverPassForAClosedPosition) {
  for (const double huge : {1e200, -1e300, 1e-320}) {
    ASSERT_EQ(koppel_state_set(state, KOPPEL_Q, std::vector<double>(coordinates, huge).data(), coordinates), KOPPEL_OK);
    auto report = sized<koppel_report>();
    if (koppel_close(state, work, nullptr, &report, nullptr) < KOPPEL_OK) continue;
    EXPECT_LT(report.residual, 1e-10) << huge;
    for (const double q : read(host).q) EXPECT_TRUE(std::isfinite(q)) << huge;
  }
}

TEST(Failure, LeavesTheStateAsItWas) {
  const Host host("5link");
  ASSERT_GE(host.move(0.5), KOPPEL_OK);
  const Reading before = read(host);
  auto error = sized<koppel_error>();
  auto report = sized<koppel_report>();
  ASSERT_EQ(koppel_state_set_input(host.state.get(), 0, 5.0, 0.0, 0.0), KOPPEL_OK);  // a wheel travel of 5 m
  EXPECT_EQ(koppel_close(host.state.get(), host.work.get(), nullptr, &report, &error), KOPPEL_NOT_CLOSED);
  EXPECT_TRUE(read(host) == before);
  EXPECT_EQ(report.verdict, KOPPEL_VERDICT_LIMIT);
  EXPECT_STREQ(error.code, "E0705");
  EXPECT_STRNE(error.advice, "");
  // Rates belong to a position that is closed for the inputs.
  EXPECT_EQ(koppel_velocities(host.state.get(), host.work.get(), &error), refused);
  EXPECT_STREQ(error.code, "E0704");
  EXPECT_EQ(koppel_accelerations(host.state.get(), host.work.get(), &error), refused);
  EXPECT_TRUE(read(host) == before);
  // The way back is open.
  EXPECT_GE(host.move(0.5), KOPPEL_OK);
}

TEST(Failure, IsWhatRatesOfAnOpenStateAre) {
  const Host host("5link");
  EXPECT_EQ(koppel_velocities(host.state.get(), host.work.get(), nullptr), refused);
  ASSERT_GE(koppel_close(host.state.get(), host.work.get(), nullptr, nullptr, nullptr), KOPPEL_OK);
  EXPECT_EQ(koppel_accelerations(host.state.get(), host.work.get(), nullptr), refused);
  EXPECT_EQ(koppel_velocities(host.state.get(), host.work.get(), nullptr), KOPPEL_OK);
  EXPECT_EQ(koppel_accelerations(host.state.get(), host.work.get(), nullptr), KOPPEL_OK);
}

}  // namespace
}  // namespace koppel::test
