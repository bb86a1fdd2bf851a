// Every fault that a plugin can have is found, and the finding names the file, the type and what is wrong in it.
#include <filesystem>

#include "fixtures.hpp"
#include "folders.hpp"
#include "plugin/motion.hpp"

namespace koppel::test {
namespace {

struct Fault {
  std::string file;
  Code code;
  std::vector<std::string> mentioned;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.file; }

std::filesystem::path path_of(const std::string& file) {
  return std::filesystem::path(test_plugins_folder()) / "bad" / (file + ".so");
}

std::string test_name(const testing::TestParamInfo<Fault>& info) { return info.param.file; }

class RefusedWhenLoaded : public testing::TestWithParam<Fault> {};

TEST_P(RefusedWhenLoaded, NamesFileAndFault) {
  Registry registry(linked_in());
  const auto loaded = registry.load(path_of(GetParam().file));
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, GetParam().code) << render(loaded.error());
  expect_mentions(loaded.error(), {path_of(GetParam().file).string()});
  expect_mentions(loaded.error(), GetParam().mentioned);
}

TEST_P(RefusedWhenLoaded, OffersNothing) {
  RegistryOptions options;
  options.plugin_path = {path_of(GetParam().file).parent_path()};
  Registry registry(std::move(options));
  const auto type = registry.function("bad.function", {GetParam().file + ".so", {}});
  ASSERT_FALSE(type);
  EXPECT_EQ(type.error().code, GetParam().code) << render(type.error());
}

constexpr Code malformed = Code::plugin_malformed;

INSTANTIATE_TEST_SUITE_P(
    Library, RefusedWhenLoaded,
    testing::Values(Fault{"missing", Code::plugin_not_found, {"missing.so"}},
                    Fault{"no_library", Code::plugin_unloadable, {"cannot be loaded"}},
                    Fault{"unresolved", Code::plugin_unloadable, {"nobody_defines_this"}},
                    Fault{"no_entry", Code::plugin_without_entry, {"koppel_plugin"}},
                    Fault{"entry_without_size", malformed, {"koppel_plugin", "struct_size is 0"}},
                    Fault{"entry_too_small", malformed, {"koppel_plugin", "struct_size is 24"}},
                    Fault{"other_major", Code::plugin_version, {"abi is 1.", "serves 0."}},
                    Fault{"minor_too_new", Code::plugin_version, {"abi is 0.2", "serves 0.1", "update koppel"}},
                    Fault{"vendor_null", malformed, {"name is missing"}},
                    Fault{"init_refuses_engine", Code::plugin_version, {"init()"}},
                    Fault{"init_fails", Code::plugin_refused, {"init() returned -6", "no licence", "come back"}},
                    Fault{"type_table_null", malformed, {"type_table is NULL"}},
                    Fault{"type_table_empty", malformed, {"type_table() offers no type"}},
                    Fault{"type_twice", malformed, {"bad.joint", "twice"}},
                    Fault{"type_table_endless", malformed, {"bad.joint", "twice"}}),
    test_name);

INSTANTIATE_TEST_SUITE_P(Type, RefusedWhenLoaded,
                         testing::Values(Fault{"joint_too_small", malformed, {"joint table 0", "struct_size is 16"}},
                                         Fault{"joint_huge", malformed, {"joint table 0", "struct_size is 4294967295"}},
                                         Fault{"type_null", malformed, {"joint table 0", "type is NULL"}},
                                         Fault{
                                             "type_too_small", malformed, {"joint table 0", "type: struct_size is 8"}},
                                         Fault{"type_name_null", malformed, {"joint table 0", "no name"}},
                                         Fault{"type_name_plain", malformed, {"`joint`", "belong to koppel"}},
                                         Fault{"type_name_foreign", malformed, {"`acme.joint`", "`bad.`"}}),
                         test_name);

INSTANTIATE_TEST_SUITE_P(
    Parameter, RefusedWhenLoaded,
    testing::Values(Fault{"parameters_null", malformed, {"bad.joint", "parameter 0 is NULL"}},
                    Fault{"parameters_countless", malformed, {"bad.joint", "parameters"}},
                    Fault{"parameter_too_small", malformed, {"bad.joint", "parameter 0", "struct_size is 8"}},
                    Fault{"parameter_crooked", malformed, {"bad.joint", "parameter", "struct_size"}},
                    Fault{"parameter_name_null", malformed, {"bad.joint", "parameter 1", "name is NULL"}},
                    Fault{"parameter_name_twice", malformed, {"bad.joint", "parameter 1", "`first` stands twice"}},
                    Fault{"parameter_name_spaced", malformed, {"bad.joint", "`two words`"}},
                    Fault{"parameter_kind", malformed, {"bad.joint", "`second`", "kind is 77"}},
                    Fault{"parameter_frame", malformed, {"bad.joint", "`second`", "for constraints and forces only"}},
                    Fault{"parameter_table_without_columns", malformed, {"bad.joint", "`second`", "columns = 0"}},
                    Fault{"parameter_counts", malformed, {"bad.joint", "`second`", "count_min is 4"}},
                    Fault{"parameter_fallback", malformed, {"bad.joint", "`second`", "fallback"}},
                    Fault{"parameter_minimum", malformed, {"bad.joint", "`second`", "minimum"}}),
    test_name);

INSTANTIATE_TEST_SUITE_P(
    Joint, RefusedWhenLoaded,
    testing::Values(Fault{"coordinates_null", malformed, {"bad.joint", "coordinate 0 is NULL"}},
                    Fault{"coordinate_name_null", malformed, {"bad.joint", "coordinate 1", "name is NULL"}},
                    Fault{"coordinate_name_twice", malformed, {"bad.joint", "coordinate 1", "`angle` stands twice"}},
                    Fault{"coordinate_kind", malformed, {"bad.joint", "`displacement`", "kind is 0"}},
                    Fault{"no_motion", malformed, {"bad.joint", "motions and pose are both NULL"}},
                    Fault{"motions_and_pose", malformed, {"bad.joint", "motions and pose are both given"}},
                    Fault{"unit_vector_product", malformed, {"bad.joint", "unit vector"}},
                    Fault{"implicit_alone", malformed, {"bad.joint", "coordinates_of is NULL"}},
                    Fault{"implicit_rows", malformed, {"bad.joint", "row_count is 3", "4"}},
                    Fault{"implicit_null", malformed, {"bad.joint", "implicit is NULL"}}),
    test_name);

INSTANTIATE_TEST_SUITE_P(
    Others, RefusedWhenLoaded,
    testing::Values(Fault{"inertia_null", malformed, {"bad.body", "inertia is NULL"}},
                    Fault{"body_coordinates", malformed, {"bad.body", "coordinates are reserved"}},
                    Fault{"residual_null", malformed, {"bad.constraint", "residual is NULL"}},
                    Fault{"jacobian_null", malformed, {"bad.constraint", "jacobian is NULL"}},
                    Fault{"second_order_null", malformed, {"bad.constraint", "second_order is NULL"}},
                    Fault{"one_frame", malformed, {"bad.constraint", "1 parameters of kind FRAME"}},
                    Fault{"no_rows", malformed, {"bad.constraint", "row_count is 0"}},
                    Fault{"row_name_null", malformed, {"bad.constraint", "row 0", "name is NULL"}},
                    Fault{"row_unit_null", malformed, {"bad.constraint", "`row`", "unit is NULL"}},
                    Fault{"second_frame_optional", malformed, {"bad.constraint", "not required", "both frames"}},
                    Fault{"evaluate_null", malformed, {"bad.function", "evaluate is NULL"}}),
    test_name);

INSTANTIATE_TEST_SUITE_P(
    Force, RefusedWhenLoaded,
    testing::Values(Fault{"force_too_small", malformed, {"force table 0", "struct_size is 16"}},
                    Fault{"act_null", malformed, {"bad.force", "evaluate is NULL"}},
                    Fault{"act_on_nothing", malformed, {"bad.force", "no parameter of kind FRAME or COORDINATES"}},
                    Fault{"act_on_three_frames", malformed, {"bad.force", "3 parameters of kind FRAME", "two at most"}},
                    Fault{"no_frame_required", malformed, {"bad.force", "none of its parameters of kind FRAME"}},
                    Fault{"act_on_two_lists", malformed, {"bad.force", "more than one parameter of kind COORDINATES"}},
                    Fault{"states_null", malformed, {"bad.force", "state 0 is NULL"}},
                    Fault{"state_name_null", malformed, {"bad.force", "state 1", "name is NULL"}},
                    Fault{"state_name_twice", malformed, {"bad.force", "state 1", "`wear` stands twice"}},
                    Fault{"state_unit_null", malformed, {"bad.force", "`state`", "unit is NULL"}},
                    Fault{"initial_of_nothing", malformed, {"bad.force", "initial is given", "state_count is 0"}},
                    Fault{"dissipation_alone", malformed, {"bad.force", "energy is NULL", "always 0"}},
                    Fault{"switches_null", malformed, {"bad.force", "switches is NULL"}},
                    Fault{"switches_uncounted", malformed, {"bad.force", "switch_count is 0"}},
                    Fault{"switches_countless", malformed, {"bad.force", "switches"}}),
    test_name);

/// These load; the fault shows when an instance is made or its motions are asked for.
class FoundInUse : public testing::TestWithParam<Fault> {};

Result<std::vector<koppel_motion>> motions_of(const std::string& file) {
  Registry registry(linked_in());
  KOPPEL_CHECK(registry.load(path_of(file)));
  KOPPEL_TRY(const JointType* type, registry.joint("bad.joint", {}));
  KOPPEL_TRY(const Instance instance, create(*type, {{"first", {1}}}));
  return joint_motions(*type, instance);
}

TEST_P(FoundInUse, NamesTypeAndFault) {
  const auto motions = motions_of(GetParam().file);
  ASSERT_FALSE(motions);
  EXPECT_EQ(motions.error().code, GetParam().code) << render(motions.error());
  expect_mentions(motions.error(), {"bad.joint"});
  expect_mentions(motions.error(), GetParam().mentioned);
}

INSTANTIATE_TEST_SUITE_P(
    Joint, FoundInUse,
    testing::Values(Fault{"create_refuses", Code::instance_refused, {"`second`", "is not to my taste", "try 7"}},
                    Fault{"create_is_silent", Code::instance_refused, {"create() returned -2"}},
                    Fault{"motions_fail", Code::plugin_misbehaved, {"motions() returned -10"}},
                    Fault{"motions_too_few", malformed, {"writes 1 motions for 2 coordinates"}},
                    Fault{"motions_too_many", malformed, {"more motions than there are coordinates"}},
                    Fault{"motion_too_small", malformed, {"struct_size to 8"}},
                    Fault{"motion_kind", malformed, {"motion 0", "kind is 9"}},
                    Fault{"motion_mismatch", malformed, {"motion 0", "`angle` is of another kind"}},
                    Fault{"quaternion_turned", malformed, {"motion 1", "`displacement` is of another kind"}},
                    Fault{
                        "motion_coordinate_twice", malformed, {"motion 1", "`displacement` moves another one already"}},
                    Fault{"motion_coordinate_unknown", malformed, {"motion 0", "coordinate 2 of 2"}},
                    Fault{"motion_axis_long", malformed, {"motion 0", "axis has length 1.000001"}},
                    Fault{"motion_axis_nan", Code::plugin_misbehaved, {"motion 0", "axis is not finite"}},
                    Fault{"motion_point_nan", Code::plugin_misbehaved, {"motion 0", "point is not finite"}},
                    Fault{"motion_pitch_infinite", Code::plugin_misbehaved, {"motion 0", "pitch is not finite"}}),
    test_name);

TEST(BadPlugins, DifferFromOneThatIsFine) {
  const auto motions = motions_of("good");
  ASSERT_TRUE(motions) << render(motions.error());
  ASSERT_EQ(motions->size(), 2u);
  EXPECT_EQ((*motions)[0].kind, KOPPEL_MOTION_SCREW);
  EXPECT_EQ((*motions)[0].point[0], 0.5);
  EXPECT_EQ((*motions)[1].pitch, 0.0);
}

TEST(BadPlugins, AFolderIsNoPlugin) {
  Registry registry(linked_in());
  const auto loaded = registry.load(test_plugins_folder());
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, Code::plugin_unloadable);
}

}  // namespace
}  // namespace koppel::test
