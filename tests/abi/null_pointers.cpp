// NULL for every pointer of every function that needs one: refused, and what else could be written stays as it was.
#include "folders.hpp"
#include "host.hpp"

namespace koppel::test {
namespace {

constexpr koppel_status refused = KOPPEL_INVALID_ARGUMENT;

class NullPointers : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_GE(host.move(0.0), KOPPEL_OK); }

  Host host{"rstr"};
  koppel_engine* engine = host.engine.get();
  koppel_scene* scene = host.scene.get();
  koppel_mechanism* mechanism = host.mechanism.get();
  koppel_state* state = host.state.get();
  koppel_work* work = host.work.get();
  std::vector<double> numbers = std::vector<double>(256);
  std::size_t needed = 77;
  char text[64] = "as before";
};

TEST_F(NullPointers, OfCodesAndDiagnosticsAreRefused) {
  koppel_diagnostics* list = nullptr;
  ASSERT_EQ(koppel_diagnostics_create(&list), KOPPEL_OK);
  const Diagnostics owned(list);
  auto finding = sized<koppel_error>();
  EXPECT_EQ(koppel_explain_code(nullptr, text, sizeof text, &needed), refused);
  EXPECT_EQ(koppel_diagnostics_create(nullptr), refused);
  EXPECT_EQ(koppel_diagnostics_count(nullptr), 0u);
  EXPECT_EQ(koppel_diagnostics_get(nullptr, 0, &finding), refused);
  EXPECT_EQ(koppel_diagnostics_get(list, 0, nullptr), refused);
  EXPECT_EQ(koppel_diagnostics_render(nullptr, text, sizeof text, &needed), refused);
  EXPECT_STREQ(text, "as before");
  EXPECT_EQ(needed, 77u);
}

TEST_F(NullPointers, OfEnginesAreRefused) {
  const koppel_plugin_entry entry{};
  EXPECT_EQ(koppel_engine_create(KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_engine_add_plugin(nullptr, &entry, nullptr), refused);
  EXPECT_EQ(koppel_engine_add_plugin(engine, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_engine_load_plugin(nullptr, "acme.so", nullptr), refused);
  EXPECT_EQ(koppel_engine_load_plugin(engine, nullptr, nullptr), refused);
}

TEST_F(NullPointers, OfScenesAreRefused) {
  Output<koppel_scene*> out;
  EXPECT_EQ(koppel_scene_from_file(nullptr, "a.toml", nullptr, &out, nullptr), refused);
  EXPECT_EQ(koppel_scene_from_file(engine, nullptr, nullptr, &out, nullptr), refused);
  EXPECT_EQ(koppel_scene_from_file(engine, (scenes_folder() + "/rstr.toml").c_str(), nullptr, nullptr, nullptr),
            refused);
  EXPECT_EQ(koppel_scene_from_text(nullptr, "", 0, nullptr, nullptr, &out, nullptr), refused);
  EXPECT_EQ(koppel_scene_from_text(engine, nullptr, 0, nullptr, nullptr, &out, nullptr), refused);
  EXPECT_EQ(koppel_scene_from_text(engine, "schema = 1", 10, nullptr, nullptr, nullptr, nullptr), refused);
  EXPECT_TRUE(out.untouched());
}

TEST_F(NullPointers, OfMechanismsAreRefused) {
  Output<koppel_mechanism*> out;
  Output<std::size_t> index;
  auto sizes = sized<koppel_sizes>();
  auto settings = sized<koppel_settings>();
  auto closure = sized<koppel_closure>();
  auto inertia = sized<koppel_inertia>();
  EXPECT_EQ(koppel_mechanism_compile(nullptr, nullptr, &out, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_compile(scene, nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_sizes(nullptr, &sizes), refused);
  EXPECT_EQ(koppel_mechanism_sizes(mechanism, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_settings(nullptr, &settings), refused);
  EXPECT_EQ(koppel_mechanism_settings(mechanism, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_name(nullptr, KOPPEL_KIND_BODY, 0, text, sizeof text, &needed), refused);
  EXPECT_EQ(koppel_mechanism_name(mechanism, KOPPEL_KIND_BODY, 0, nullptr, 0, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_unit(nullptr, KOPPEL_KIND_BODY, 0, text, sizeof text, &needed), refused);
  EXPECT_EQ(koppel_mechanism_unit(mechanism, KOPPEL_KIND_BODY, 0, nullptr, 0, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_find(nullptr, KOPPEL_KIND_BODY, "crank", &index, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_find(mechanism, KOPPEL_KIND_BODY, nullptr, &index, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_find(mechanism, KOPPEL_KIND_BODY, "crank", nullptr, nullptr), refused);
  EXPECT_EQ(koppel_mechanism_closure(nullptr, 0, &closure, nullptr, 0), refused);
  EXPECT_EQ(koppel_mechanism_closure(mechanism, 0, nullptr, nullptr, 0), refused);
  EXPECT_EQ(koppel_mechanism_explain(nullptr, text, sizeof text, &needed), refused);
  EXPECT_EQ(koppel_mechanism_explain(mechanism, nullptr, 0, nullptr), refused);
  EXPECT_EQ(koppel_body_inertia(nullptr, 1, &inertia, nullptr), refused);
  EXPECT_EQ(koppel_body_inertia(mechanism, 1, nullptr, nullptr), refused);
  EXPECT_TRUE(out.untouched());
  EXPECT_TRUE(index.untouched());
  EXPECT_STREQ(text, "as before");
  EXPECT_EQ(needed, 77u);
}

TEST_F(NullPointers, OfStatesAreRefused) {
  Output<koppel_state*> out;
  const Reading before = read(host);
  EXPECT_EQ(koppel_state_create(nullptr, &out), refused);
  EXPECT_EQ(koppel_state_create(mechanism, nullptr), refused);
  EXPECT_EQ(koppel_state_copy(nullptr, state), refused);
  EXPECT_EQ(koppel_state_copy(state, nullptr), refused);
  EXPECT_EQ(koppel_state_get(nullptr, KOPPEL_Q, numbers.data(), host.sizes.coordinates), refused);
  EXPECT_EQ(koppel_state_get(state, KOPPEL_Q, nullptr, host.sizes.coordinates), refused);
  EXPECT_EQ(koppel_state_set(nullptr, KOPPEL_Q, numbers.data(), host.sizes.coordinates), refused);
  EXPECT_EQ(koppel_state_set(state, KOPPEL_Q, nullptr, host.sizes.coordinates), refused);
  EXPECT_EQ(koppel_state_set_time(nullptr, 0.0, nullptr), refused);
  EXPECT_EQ(koppel_state_time(nullptr), 0.0);
  EXPECT_EQ(koppel_limits_exceeded(nullptr, nullptr, 0, nullptr), refused);
  EXPECT_EQ(koppel_state_set_input(nullptr, 0, 0.0, 0.0, 0.0), refused);
  EXPECT_TRUE(out.untouched());
  EXPECT_TRUE(read(host) == before);
}

TEST_F(NullPointers, OfSolversAreRefused) {
  Output<koppel_work*> out;
  auto analysis = sized<koppel_analysis>();
  const Reading before = read(host);
  EXPECT_EQ(koppel_work_create(nullptr, &out), refused);
  EXPECT_EQ(koppel_work_create(mechanism, nullptr), refused);
  EXPECT_EQ(koppel_close(nullptr, work, nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_close(state, nullptr, nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_velocities(nullptr, work, nullptr), refused);
  EXPECT_EQ(koppel_velocities(state, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_accelerations(nullptr, work, nullptr), refused);
  EXPECT_EQ(koppel_accelerations(state, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_move(nullptr, work, 0.1, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_move(state, nullptr, 0.1, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_move_on(nullptr, work, 0.1, nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_move_on(state, nullptr, 0.1, nullptr, nullptr, nullptr), refused);
  size_t count = 0;
  EXPECT_EQ(koppel_independent(nullptr, work, nullptr, 0, &count, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_independent(state, nullptr, nullptr, 0, &count, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_independent(state, work, nullptr, 4, &count, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_independent(state, work, nullptr, 0, nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_follow(nullptr, work, 0.1, nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_follow(state, nullptr, 0.1, nullptr, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_analyse(nullptr, work, &analysis, nullptr), refused);
  EXPECT_EQ(koppel_analyse(state, nullptr, &analysis, nullptr), refused);
  EXPECT_EQ(koppel_analyse(state, work, nullptr, nullptr), refused);
  auto freedoms = sized<koppel_freedoms>();
  EXPECT_EQ(koppel_find_freedoms(nullptr, work, &freedoms, nullptr), refused);
  EXPECT_EQ(koppel_find_freedoms(state, nullptr, &freedoms, nullptr), refused);
  EXPECT_EQ(koppel_find_freedoms(state, work, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_explain_freedoms(nullptr, work, text, sizeof text, nullptr), refused);
  EXPECT_EQ(koppel_explain_freedoms(state, nullptr, text, sizeof text, nullptr), refused);
  EXPECT_TRUE(out.untouched());
  EXPECT_TRUE(read(host) == before);
}

TEST_F(NullPointers, OfFlowAndModesAreRefused) {
  EXPECT_EQ(koppel_flow_explain(nullptr, KOPPEL_FLOW_TEXT, text, sizeof text, &needed), refused);
  EXPECT_EQ(koppel_flow_explain(mechanism, KOPPEL_FLOW_TEXT, nullptr, 0, nullptr), refused);
  Output<koppel_modes*> out;
  EXPECT_EQ(koppel_modes_find(nullptr, work, nullptr, &out, nullptr), refused);
  EXPECT_EQ(koppel_modes_find(state, nullptr, nullptr, &out, nullptr), refused);
  EXPECT_EQ(koppel_modes_find(state, work, nullptr, nullptr, nullptr), refused);
  EXPECT_TRUE(out.untouched());
  koppel_modes* found = nullptr;
  ASSERT_EQ(koppel_modes_find(state, work, nullptr, &found, nullptr), KOPPEL_OK);
  const Modes modes(found);
  const Reading before = read(host);
  auto summary = sized<koppel_modes_summary>();
  auto mode = sized<koppel_mode>();
  EXPECT_EQ(koppel_modes_summarise(nullptr, &summary), refused);
  EXPECT_EQ(koppel_modes_summarise(found, nullptr), refused);
  EXPECT_EQ(koppel_modes_why(nullptr, text, sizeof text, &needed), refused);
  EXPECT_EQ(koppel_modes_why(found, nullptr, 0, nullptr), refused);
  EXPECT_EQ(koppel_modes_get(nullptr, 0, &mode), refused);
  EXPECT_EQ(koppel_modes_get(found, 0, nullptr), refused);
  EXPECT_EQ(koppel_modes_id(nullptr, 0, text, sizeof text, &needed), refused);
  EXPECT_EQ(koppel_modes_id(found, 0, nullptr, 0, nullptr), refused);
  EXPECT_EQ(koppel_modes_take(nullptr, 0, state), refused);
  EXPECT_EQ(koppel_modes_take(found, 0, nullptr), refused);
  EXPECT_TRUE(read(host) == before);
  EXPECT_STREQ(text, "as before");
  EXPECT_EQ(needed, 77u);
}

TEST_F(NullPointers, OfResultsAreRefused) {
  const std::size_t twelve = 12 * std::size_t{host.sizes.bodies}, six = 6 * std::size_t{host.sizes.bodies};
  const std::size_t jacobian = 6 * std::size_t{host.sizes.rates};
  double* out = numbers.data();
  EXPECT_EQ(koppel_poses(nullptr, work, KOPPEL_KIND_BODY, out, twelve), refused);
  EXPECT_EQ(koppel_poses(state, nullptr, KOPPEL_KIND_BODY, out, twelve), refused);
  EXPECT_EQ(koppel_poses(state, work, KOPPEL_KIND_BODY, nullptr, twelve), refused);
  EXPECT_EQ(koppel_twists(nullptr, work, KOPPEL_KIND_BODY, out, six), refused);
  EXPECT_EQ(koppel_twists(state, nullptr, KOPPEL_KIND_BODY, out, six), refused);
  EXPECT_EQ(koppel_twists(state, work, KOPPEL_KIND_BODY, nullptr, six), refused);
  EXPECT_EQ(koppel_frame_accelerations(nullptr, work, KOPPEL_KIND_BODY, out, six), refused);
  EXPECT_EQ(koppel_frame_accelerations(state, nullptr, KOPPEL_KIND_BODY, out, six), refused);
  EXPECT_EQ(koppel_frame_accelerations(state, work, KOPPEL_KIND_BODY, nullptr, six), refused);
  EXPECT_EQ(koppel_jacobian(nullptr, work, KOPPEL_KIND_BODY, 1, out, nullptr, jacobian), refused);
  EXPECT_EQ(koppel_jacobian(state, nullptr, KOPPEL_KIND_BODY, 1, out, nullptr, jacobian), refused);
  EXPECT_EQ(koppel_jacobian(state, work, KOPPEL_KIND_BODY, 1, nullptr, out, jacobian), refused);
  EXPECT_EQ(koppel_records(nullptr, work, out, host.sizes.records), refused);
  EXPECT_EQ(koppel_records(state, nullptr, out, host.sizes.records), refused);
  EXPECT_EQ(koppel_records(state, work, nullptr, host.sizes.records), refused);
  EXPECT_EQ(numbers, std::vector<double>(numbers.size()));
}

TEST_F(NullPointers, OfStreamsAreRefused) {
  Output<koppel_stream*> out;
  auto options = sized<koppel_stream_options>();
  options.url = "memq://";
  EXPECT_EQ(koppel_stream_open(nullptr, &options, &out, nullptr), refused);
  EXPECT_EQ(koppel_stream_open(mechanism, &options, nullptr, nullptr), refused);
  EXPECT_TRUE(out.untouched());
  koppel_stream* stream = nullptr;
  ASSERT_EQ(koppel_stream_open(mechanism, &options, &stream, nullptr), KOPPEL_OK);
  const Stream owned(stream);
  EXPECT_EQ(koppel_stream_publish(nullptr, state, work, nullptr), refused);
  EXPECT_EQ(koppel_stream_publish(stream, nullptr, work, nullptr), refused);
  EXPECT_EQ(koppel_stream_publish(stream, state, nullptr, nullptr), refused);
  EXPECT_EQ(koppel_stream_event(nullptr, 0.0, KOPPEL_SEVERITY_NOTE, "text"), refused);
  EXPECT_EQ(koppel_stream_event(stream, 0.0, KOPPEL_SEVERITY_NOTE, nullptr), refused);
}

TEST_F(NullPointers, ThatStandForNothingToFreeAreFine) {
  koppel_engine_destroy(nullptr);
  koppel_diagnostics_destroy(nullptr);
  koppel_scene_destroy(nullptr);
  koppel_mechanism_destroy(nullptr);
  koppel_state_destroy(nullptr);
  koppel_work_destroy(nullptr);
  koppel_modes_destroy(nullptr);
  EXPECT_EQ(koppel_stream_close(nullptr, nullptr), KOPPEL_OK);
}

TEST_F(NullPointers, ThatStandForLessAreFine) {
  EXPECT_EQ(koppel_mechanism_name(mechanism, KOPPEL_KIND_BODY, 0, text, sizeof text, nullptr), KOPPEL_OK);
  EXPECT_EQ(koppel_mechanism_name(mechanism, KOPPEL_KIND_BODY, 0, nullptr, 0, &needed), KOPPEL_OK);
  EXPECT_EQ(needed, sizeof "ground");
  EXPECT_EQ(
      koppel_jacobian(state, work, KOPPEL_KIND_BODY, 1, numbers.data(), nullptr, 6 * std::size_t{host.sizes.rates}),
      KOPPEL_OK);
  EXPECT_GE(koppel_close(state, work, nullptr, nullptr, nullptr), KOPPEL_OK);
}

}  // namespace
}  // namespace koppel::test
