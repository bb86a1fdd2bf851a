// Each kind of fault in a scene has its own clear finding: code, place, what is marked, and a remedy. One fault, one
// error: nothing else is reported in its wake.
#include <ostream>

#include "scene_reader.hpp"

namespace koppel {
namespace {

// Two bodies, lines 1 to 5; a pin between ground and crank, lines 6 to 9.
#define BODIES "schema = 1\n[[body]]\nname = 'crank'\n[[body]]\nname = 'rod'\n"
#define PIN BODIES "[[joint]]\nname = 'pin'\ntype = 'revolute'\nbetween = ['ground', 'crank']\n"
#define BALL BODIES "[[joint]]\nname = 'ball'\ntype = 'spherical'\nbetween = ['ground', 'crank']\n"
#define SPRING PIN "[[force]]\nname = 's'\ntype = 'spring'\nfrom = 'ground'\nto = 'rod'\n"
#define TORSION PIN "[[force]]\nname = 't'\ntype = 'coordinate_spring'\nof = 'pin.angle'\n"
#define SIMULATION "schema = 1\n[simulation]\n"
#define DRIVE PIN "[[drive]]\nof = 'pin.angle'\ntype = 'ramp'\nstart = 0\nslope = 1\n"

struct Fault {
  const char* name;
  const char* text;
  Code code;
  int line;
  const char* marked;  ///< what the caret stands under
  const char* says;    ///< a piece of message or advice
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

const Fault faults[] = {
    // Structure
    {"syntax", "schema = 1\n[[body]\nname = 'a'\n", Code::toml_syntax, 2, "", "']'"},
    {"open_string", "schema = 1\n[scene]\nname = \"x\n", Code::toml_syntax, 3, "", ""},
    {"key_twice", "schema = 1\n[scene]\nname = 'a'\nname = 'b'\n", Code::toml_syntax, 4, "", ""},
    {"endless_key", "schema = 1\na.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a = 1\n",
     Code::toml_syntax, 2, ".", "nested"},
    {"deep_tables",
     "schema = 1\na = [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[ 1 "
     "]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]\n",
     Code::toml_syntax, 2, "", "nested"},
    {"no_schema", "[scene]\nname = 'a'\n", Code::unknown_schema, 1, "[", "schema = 1"},
    {"schema_of_tomorrow", "schema = 2\n[nonsense]\n", Code::unknown_schema, 1, "2", "schema 1"},
    {"schema_as_text", "schema = '1'\n", Code::unknown_schema, 1, "'1'", "schema = 1"},
    {"unknown_table", BODIES "[[joints]]\nname = 'a'\n", Code::unknown_table, 6, "joints", "did you mean `joint`?"},
    {"unknown_top_level_key", "schema = 1\nradius = 3\n", Code::unknown_table, 2, "radius", "[parameters]"},
    {"misspelt_force", "schema = 1\n[[forces]]\nname = 'f'\n", Code::unknown_table, 2, "forces",
     "did you mean `force`?"},
    {"force_without_type", "schema = 1\n[[force]]\nname = 'f'\n", Code::missing_key, 2, "[[force]]", "`type`"},
    {"force_without_name", "schema = 1\n[[force]]\ntype = 'spring'\nfrom = 'ground'\nto = 'ground'\n",
     Code::missing_key, 2, "[[force]]", "`name`"},
    {"force_twice", SPRING "[[force]]\nname = 's'\ntype = 'spring'\nfrom = 'ground'\nto = 'rod'\n",
     Code::duplicate_name, 16, "'s'", "taken"},
    {"force_with_one_frame", PIN "[[force]]\nname = 's'\ntype = 'spring'\nto = 'rod'\n", Code::missing_key, 10,
     "[[force]]", "`from` is missing"},
    {"force_of_unknown_type", PIN "[[force]]\nname = 's'\ntype = 'sprng'\nto = 'rod'\n", Code::unknown_type, 12,
     "'sprng'", "did you mean `spring`?"},
    {"force_of_a_joints_type", PIN "[[force]]\nname = 's'\ntype = 'revolute'\n", Code::unknown_type, 12, "'revolute'",
     "is a joint type, not a force type"},
    {"force_at_unknown_frame", PIN "[[force]]\nname = 's'\ntype = 'spring'\nfrom = 'ground'\nto = 'rot'\n",
     Code::unknown_frame, 14, "'rot'", "did you mean `rod`?"},
    {"force_on_unknown_coordinate", PIN "[[force]]\nname = 't'\ntype = 'motor'\nof = 'pin.angel'\n",
     Code::unknown_coordinate, 13, "angel", "`angle`"},
    {"force_on_a_ball", BALL "[[force]]\nname = 't'\ntype = 'motor'\nof = 'ball.rotation'\n", Code::not_scalar, 13,
     "'ball.rotation'", "single length or angle"},
    {"misspelt_stiffness", SPRING "stifness = 3\n", Code::unknown_key, 15, "stifness", "did you mean `stiffness`?"},
    {"negative_damping", SPRING "damping = -3\n", Code::out_of_range, 15, "-3", "at least 0 N s/m"},
    {"angle_as_free_length", SPRING "length = '3 deg'\n", Code::wrong_kind, 15, "'3 deg'", "in m, not in rad"},
    {"length_as_free_angle", TORSION "free = '3 mm'\n", Code::wrong_kind, 14, "'3 mm'", "in rad, not in m"},
    {"table_of_one_row", TORSION "table = [[0, 0]]\n", Code::wrong_count, 14, "[[0, 0]]", "at least 2"},
    {"simulation_is_no_table", "schema = 1\nsimulation = 3\n", Code::wrong_kind, 2, "3", "[simulation]"},
    {"unknown_key_in_simulation", SIMULATION "tolerence = 1e-6\n", Code::unknown_key, 3, "tolerence",
     "did you mean `tolerance`?"},
    {"coarse_tolerance", SIMULATION "tolerance = 1\n", Code::out_of_range, 3, "1", "less than 1"},
    {"no_tolerance", SIMULATION "tolerance = 0\n", Code::out_of_range, 3, "0", "greater than 0"},
    {"step_backwards", SIMULATION "step = '-1 ms'\n", Code::out_of_range, 3, "'-1 ms'", "greater than 0"},
    {"step_of_an_angle", SIMULATION "step = '1 deg'\n", Code::wrong_kind, 3, "'1 deg'", "in s, not in rad"},
    {"misspelt_integrator", SIMULATION "integrator = 'dop835'\n", Code::unknown_integrator, 3, "'dop835'",
     "did you mean `dop853`?"},
    {"integrator_as_number", SIMULATION "integrator = 3\n", Code::wrong_kind, 3, "3", "a string"},
    {"fixed_steps_without_step", SIMULATION "integrator = 'classical'\n", Code::missing_key, 3, "'classical'",
     "give `step`"},
    {"watch_without_subject", "schema = 1\n[[watch]]\n", Code::missing_key, 2, "[[watch]]", "joint.coordinate"},
    {"watch_of_unknown_coordinate", PIN "[[watch]]\nof = 'pin.angel'\n", Code::unknown_coordinate, 11, "angel",
     "`angle`"},
    {"watch_of_an_acceleration", PIN "[[watch]]\nof = 'pin.angle'\nquantity = 'acceleration'\n", Code::unknown_quantity,
     12, "'acceleration'", "`rate`"},
    {"watch_backwards", PIN "[[watch]]\nof = 'pin.angle'\ndirection = 'backwards'\n", Code::out_of_range, 12,
     "'backwards'", "falling"},
    {"watch_that_stops_perhaps", PIN "[[watch]]\nof = 'pin.angle'\nstop = 'yes'\n", Code::wrong_kind, 12, "'yes'", ""},
    {"watch_in_metres", PIN "[[watch]]\nof = 'pin.angle'\nvalue = '1 mm'\n", Code::wrong_kind, 12, "'1 mm'", ""},
    {"watched_twice", PIN "[[watch]]\nof = 'pin.angle'\n[[watch]]\nof = 'pin.angle'\n", Code::duplicate_name, 13,
     "'pin.angle'", "a name"},
    {"misspelt_formulation", SIMULATION "formulation = 'minimum'\n", Code::unknown_formulation, 3, "'minimum'",
     "minimal, projected, baumgarte, ggl, index3"},
    {"formulation_of_another_integrator", SIMULATION "integrator = 'dop853'\nformulation = 'ggl'\n",
     Code::conflicting_keys, 4, "'ggl'", "the integrator ida"},
    {"projection_of_what_is_remembered", SIMULATION "integrator = 'cvode'\nformulation = 'projected'\n",
     Code::conflicting_keys, 4, "'projected'", "minimal or baumgarte"},
    {"formulation_of_fixed_steps_without_step", SIMULATION "formulation = 'index3'\n", Code::missing_key, 3, "'index3'",
     "give `step`"},
    {"step_of_an_adaptive_formulation", SIMULATION "formulation = 'ggl'\nstep = 1\n", Code::conflicting_keys, 4, "step",
     "give `tolerance` instead"},
    {"step_of_an_adaptive_integrator", SIMULATION "integrator = 'cvode'\nstep = 1\n", Code::conflicting_keys, 4, "step",
     "give `tolerance` instead"},
    {"start_rate_of_unknown_coordinate", PIN "start_rate = { angel = 1 }\n", Code::unknown_coordinate, 10, "angel",
     "`angle`"},
    {"fixed_of_unknown_coordinate", PIN "start = { angle = 1 }\nfixed = ['angel']\n", Code::unknown_coordinate, 11,
     "'angel'", "`angle`"},
    {"fixed_as_text", PIN "start = { angle = 1 }\nfixed = 'angle'\n", Code::wrong_kind, 11, "'angle'", "names"},
    {"fixed_without_start", PIN "fixed = ['angle']\n", Code::missing_key, 10, "'angle'", "`start`"},
    {"fixed_quaternion", BALL "fixed = ['rotation']\n", Code::not_scalar, 10, "'rotation'", "neither"},
    {"start_rate_as_number", PIN "start_rate = 1\n", Code::wrong_kind, 10, "1", "a table"},
    {"start_rate_as_list", PIN "start_rate = { angle = [1] }\n", Code::wrong_kind, 10, "[1]", "a number"},
    {"start_rate_as_quaternion", BALL "start_rate = { rotation = [1, 0, 0, 0] }\n", Code::wrong_count, 10,
     "[1, 0, 0, 0]", "[wx, wy, wz]"},
    {"start_rate_in_metres", PIN "start_rate = { angle = '1 m' }\n", Code::wrong_kind, 10, "'1 m'", "in rad, not in m"},
    {"body_is_no_list", "schema = 1\n[body]\nname = 'a'\n", Code::wrong_kind, 2, "[body]", "[[body]]"},
    {"body_of_numbers", "schema = 1\nbody = [3]\n", Code::wrong_kind, 2, "3", "[[body]]"},
    {"scene_is_no_table", "schema = 1\nscene = 3\n", Code::wrong_kind, 2, "3", "[scene]"},
    {"parameters_are_no_table", "schema = 1\nparameters = 3\n", Code::wrong_kind, 2, "3", "name = value"},
    {"unknown_key", PIN "axs = [0, 1, 0]\n", Code::unknown_key, 10, "axs", "did you mean `axis`?"},
    {"strange_key", PIN "colour = 'red'\n", Code::unknown_key, 10, "colour", "known here"},
    {"unknown_key_in_scene", "schema = 1\n[scene]\nnme = 'a'\n", Code::unknown_key, 3, "nme", "did you mean `name`?"},
    {"parameter_of_another_type", PIN "pitch = 0.01\n", Code::unknown_key, 10, "pitch", ""},
    {"no_name", "schema = 1\n[[body]]\nmass = 1\n", Code::missing_key, 2, "[[body]]", "name"},
    {"no_type", BODIES "[[joint]]\nname = 'j'\nbetween = ['ground', 'rod']\n", Code::missing_key, 6, "[[joint]]",
     "type"},
    {"no_place", BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\n", Code::missing_key, 6, "[[joint]]", "between"},
    {"no_outlet", BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\ninlet = 'rod'\n", Code::missing_key, 6, "[[joint]]",
     "outlet"},
    {"no_required_parameter", BODIES "[[joint]]\nname = 'j'\ntype = 'helical'\nbetween = ['ground', 'rod']\n",
     Code::missing_key, 6, "[[joint]]", "`pitch` is missing"},
    {"frame_on_nothing", BODIES "[[frame]]\nname = 'f'\nat = [0, 0, 1]\n", Code::missing_key, 6, "[[frame]]", "`on`"},
    {"name_is_no_text", "schema = 1\n[[body]]\nname = 3\n", Code::wrong_kind, 3, "3", "a string, not a number"},
    {"name_with_blank", "schema = 1\n[[body]]\nname = 'my body'\n", Code::bad_name, 3, "'my body'", "letters"},
    {"name_with_dot", "schema = 1\n[[body]]\nname = 'left.body'\n", Code::bad_name, 3, "'left.body'", "letters"},
    {"bad_scene_name", "schema = 1\n[scene]\nname = 'a b'\n", Code::bad_name, 3, "'a b'", "letters"},
    {"bad_parameter_name", "schema = 1\n[parameters]\nrod-length = 1\n", Code::bad_name, 3, "rod-length", "minus"},
    {"parameter_named_like_a_unit", "schema = 1\n[parameters]\nmm = 1\n", Code::bad_name, 3, "mm", "a unit"},
    {"parameter_named_like_a_function", "schema = 1\n[parameters]\nsin = 1\n", Code::bad_name, 3, "sin", "a function"},
    {"body_twice", BODIES "[[body]]\nname = 'rod'\n", Code::duplicate_name, 7, "'rod'", "taken"},
    {"frame_named_like_a_body", BODIES "[[frame]]\nname = 'rod'\non = 'crank'\n", Code::duplicate_name, 7, "'rod'",
     "taken"},
    {"body_named_ground", "schema = 1\n[[body]]\nname = 'ground'\n", Code::duplicate_name, 3, "'ground'",
     "always there"},
    {"uses_of_a_parameter_named_like_a_unit",
     "schema = 1\n[parameters]\ns = 2\n[scene]\nlength = '2*s'\nduration = 's'\n", Code::bad_name, 3, "s", "a unit"},
    {"uses_of_a_parameter_with_a_hyphen",
     "schema = 1\n[parameters]\nrod-length = 1\n[scene]\nlength = '2*rod-length'\n", Code::bad_name, 3, "rod-length",
     "minus"},
    {"uses_of_a_body_with_a_dot",
     "schema = 1\n[[body]]\nname = 'a.b'\n[[joint]]\nname = 'j'\ntype = 'weld'\nbetween = ['ground', 'a.b']\n"
     "[[record]]\nof = 'a.b'\n",
     Code::bad_name, 3, "'a.b'", "letters"},
    {"uses_of_a_joint_with_a_blank",
     BODIES "[[joint]]\nname = 'my pin'\ntype = 'revolute'\nbetween = ['ground', 'rod']\n"
            "[[drive]]\nof = 'my pin.angle'\ntype = 'constant'\nvalue = 0\n[[record]]\nof = 'my pin.angle'\n",
     Code::bad_name, 7, "'my pin'", "letters"},
    {"joint_twice", PIN "[[joint]]\nname = 'pin'\ntype = 'weld'\nbetween = ['ground', 'rod']\n", Code::duplicate_name,
     11, "'pin'", "another name"},
    {"recorded_twice", PIN "[[record]]\nof = 'rod'\n[[record]]\nof = 'rod'\n", Code::duplicate_name, 13, "'rod'",
     "recorded already"},
    {"two_orientations", BODIES "[[frame]]\nname = 'f'\non = 'rod'\naxis = [1, 0, 0]\nquaternion = [1, 0, 0, 0]\n",
     Code::conflicting_keys, 10, "quaternion", "`axis`"},
    {"two_placements", PIN "inlet = 'rod'\n", Code::conflicting_keys, 10, "inlet", "between"},
    {"axis_without_between",
     BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\ninlet = 'ground'\noutlet = 'rod'\nat = [0,0,0]\n",
     Code::conflicting_keys, 11, "at", "between"},
    // Names
    {"unknown_body", BODIES "[[frame]]\nname = 'f'\non = 'cranc'\n", Code::unknown_body, 8, "'cranc'",
     "did you mean `crank`?"},
    {"unknown_body_of_a_joint", BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\nbetween = ['rod', 'grund']\n",
     Code::unknown_body, 9, "'grund'", "did you mean `ground`?"},
    {"frame_where_a_body_is_needed", BODIES "[[frame]]\nname = 'f'\non = 'rod'\n[[frame]]\nname = 'g'\non = 'f'\n",
     Code::unknown_body, 11, "'f'", "is a frame"},
    {"unknown_frame", BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\ninlet = 'ground'\noutlet = 'rodd'\n",
     Code::unknown_frame, 10, "'rodd'", "did you mean `rod`?"},
    {"unknown_joint", PIN "[[drive]]\nof = 'pim.angle'\ntype = 'constant'\nvalue = 1\n", Code::unknown_joint, 11, "pim",
     "did you mean `pin`?"},
    {"unknown_coordinate", PIN "[[drive]]\nof = 'pin.angel'\ntype = 'constant'\nvalue = 1\n", Code::unknown_coordinate,
     11, "angel", "`angle`"},
    {"coordinate_without_name", PIN "[[drive]]\nof = 'pin'\ntype = 'constant'\nvalue = 1\n", Code::unknown_coordinate,
     11, "'pin'", "pin.angle"},
    {"zero_of_unknown_coordinate", PIN "zero = { displacement = 1 }\n", Code::unknown_coordinate, 10, "displacement",
     "`angle`"},
    {"unknown_type", BODIES "[[joint]]\nname = 'j'\ntype = 'revolut'\nbetween = ['ground', 'rod']\n",
     Code::unknown_type, 8, "'revolut'", "revolute"},
    {"type_of_another_kind", BODIES "[[joint]]\nname = 'j'\ntype = 'rigid'\nbetween = ['ground', 'rod']\n",
     Code::unknown_type, 8, "'rigid'", ""},
    {"missing_plugin",
     BODIES "[[joint]]\nname = 'j'\ntype = 'acme.cam'\nplugin = 'acme.so'\nbetween = ['ground', 'rod']\n",
     Code::plugin_not_found, 9, "'acme.so'", "acme.so"},
    {"unknown_quantity", PIN "[[record]]\nof = 'pin.angle'\nquantity = 'ratte'\n", Code::unknown_quantity, 12,
     "'ratte'", "did you mean `rate`?"},
    {"quantity_of_a_frame", PIN "[[record]]\nof = 'rod'\nquantity = 'acceleration'\n", Code::unknown_quantity, 12,
     "'acceleration'", "linear_acceleration"},
    {"record_by_what_is_not_driven", PIN "[[record]]\nof = 'pin.angle'\nquantity = 'rate'\nby = 'pin.angle'\n",
     Code::not_driven, 13, "'pin.angle'", "[[drive]]"},
    {"record_of_a_value_by_a_drive", DRIVE "[[record]]\nof = 'pin.angle'\nby = 'pin.angle'\n", Code::unknown_quantity,
     17, "'pin.angle'", "\"rate\""},
    {"record_by_an_unknown_coordinate", DRIVE "[[record]]\nof = 'pin.angle'\nquantity = 'rate'\nby = 'pin.angel'\n",
     Code::unknown_coordinate, 18, "angel", "`angle`"},
    {"position_against_a_frame", PIN "[[record]]\nof = 'rod'\nagainst = 'crank'\n", Code::unknown_quantity, 12,
     "'crank'", "fixed_axode"},
    {"record_of_a_joint", PIN "[[record]]\nof = 'pin'\n", Code::unknown_quantity, 11, "'pin'", "`angle`"},
    {"record_of_nothing", PIN "[[record]]\nof = 'rood'\n", Code::unknown_frame, 11, "'rood'", "did you mean `rod`?"},
    {"record_of_unknown_joint", PIN "[[record]]\nof = 'pan.angle'\n", Code::unknown_joint, 11, "pan", "`pin`"},
    {"same_body", BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\nbetween = ['rod', 'rod']\n", Code::same_body, 9,
     "between", "different"},
    {"same_body_by_frames", BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\ninlet = 'rod'\noutlet = {on = 'rod'}\n",
     Code::same_body, 10, "outlet", "different"},
    {"keys_of_an_unknown_type",
     BODIES "[[joint]]\nname = 'j'\ntype = 'univrsal'\nbetween = ['ground', 'rod']\naxis2 = [1, 0, 0]\ngrease = 3\n",
     Code::unknown_type, 8, "'univrsal'", "universal"},
    // Values
    {"axis_by_letter", PIN "axis = 'x'\n", Code::wrong_kind, 10, "'x'", "write [1, 0, 0]"},
    {"direction_by_word",
     BODIES "[[joint]]\nname = 'j'\ntype = 'universal'\nbetween = ['ground', 'rod']\naxis2 = 'up'\n", Code::wrong_kind,
     10, "'up'", "[x, y, z]"},
    {"position_in_a_plane", PIN "at = [0, 0.1]\n", Code::wrong_count, 10, "[0, 0.1]", "[x, y, z]"},
    {"one_in_between", BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\nbetween = ['crank']\n", Code::wrong_count, 9,
     "['crank']", "between = [\"ground\", \"crank\"]"},
    {"position_out_of_the_world", PIN "at = [0, -1e12, 0]\n", Code::out_of_range, 10, "-1e12", "within 1e+09 m"},
    {"length_out_of_the_world", "schema = 1\n[scene]\nlength = '1e10*2'\n", Code::out_of_range, 3, "'1e10*2'",
     "120 mm"},
    {"start_out_of_the_world",
     BODIES
     "[[joint]]\nname = 'j'\ntype = 'prismatic'\nbetween = ['ground', 'rod']\nstart = { displacement = 1e300 }\n",
     Code::out_of_range, 10, "1e300", "m"},
    {"frequency_as_an_angle",
     PIN "[[drive]]\nof = 'pin.angle'\ntype = 'sine'\namplitude = '3 deg'\nfrequency = '30 deg'\n", Code::wrong_kind,
     14, "'30 deg'", "Hz"},
    {"pitch_as_an_angle",
     BODIES "[[joint]]\nname = 'j'\ntype = 'helical'\nbetween = ['ground', 'rod']\npitch = '3 deg'\n", Code::wrong_kind,
     10, "'3 deg'", "m/rad"},
    {"slope_of_an_angle_as_a_length", PIN "[[drive]]\nof = 'pin.angle'\ntype = 'ramp'\nslope = '3 mm'\n",
     Code::wrong_kind, 13, "'3 mm'", "measured in rad"},
    {"table_of_angles_with_a_length",
     PIN "[[drive]]\nof = 'pin.angle'\ntype = 'table'\npoints = [[0, 0], [1, '3 mm']]\n", Code::wrong_kind, 13,
     "'3 mm'", "measured in rad"},
    {"rate_per_second", PIN "[[drive]]\nof = 'pin.angle'\ntype = 'ramp'\nslope = '360 deg/s'\n", Code::bad_expression,
     13, "s", "rates are per second already: write 360 deg"},
    {"unit_as_divisor", PIN "at = ['2*(3 + 1)/m', 0, 0]\n", Code::bad_expression, 10, "m", "after a number: 1 m"},
    {"unit_spelt_out", PIN "zero = { angle = '360 degree' }\n", Code::bad_expression, 10, "degree",
     "units are deg rad rev m cm mm s ms kg g"},
    {"list_for_a_number", BODIES "mass = [1, 2]\n", Code::wrong_kind, 6, "[1, 2]", "a number, not a list"},
    {"boolean_for_a_list", PIN "at = true\n", Code::wrong_kind, 10, "true", "a list of 3, not a boolean"},
    {"date_for_a_number", BODIES "mass = 1979-05-27\n", Code::wrong_kind, 6, "1979-05-27", "a date"},
    {"angle_for_a_length", PIN "at = ['30 deg', 0, 0]\n", Code::wrong_kind, 10, "'30 deg'", "measured in m"},
    {"length_for_an_angle", PIN "zero = {angle = '3 mm'}\n", Code::wrong_kind, 10, "'3 mm'", "measured in rad"},
    {"part_of_a_step", "schema = 1\n[scene]\nsteps = 3.5\n", Code::wrong_kind, 3, "3.5", "whole"},
    {"parameter_is_a_list", "schema = 1\n[parameters]\na = [1]\n[scene]\nlength = 'a'\n", Code::wrong_kind, 3, "[1]",
     "a number"},
    {"bad_expression", PIN "at = [0, '2*', 0]\n", Code::bad_expression, 10, "", "too early"},
    {"two_numbers", PIN "at = [0, '2 3', 0]\n", Code::bad_expression, 10, "3", ""},
    {"unknown_word", "schema = 1\n[parameters]\ncrank = 1\n[scene]\nlength = '2*cranc + 1'\n", Code::bad_expression, 5,
     "cranc", "did you mean `crank`?"},
    {"unknown_unit", PIN "at = ['3 inch', 0, 0]\n", Code::bad_expression, 10, "inch", "units are deg rad"},
    {"missing_parenthesis", PIN "at = ['2*(3 + 1', 0, 0]\n", Code::bad_expression, 10, "", "parenthesis"},
    {"decimal_comma", PIN "at = ['1,5', 0, 0]\n", Code::bad_expression, 10, "1,5", "point"},
    {"no_gravity", "schema = 1\n[scene]\ngravity = [0, 0]\n", Code::wrong_count, 3, "[0, 0]", "3 entries, not 2"},
    {"short_inertia", BODIES "inertia = [1, 1, 1]\n", Code::wrong_count, 6, "[1, 1, 1]", "6 entries"},
    {"three_in_between", BODIES "[[joint]]\nname = 'j'\ntype = 'weld'\nbetween = ['rod', 'crank', 'ground']\n",
     Code::wrong_count, 9, "['rod', 'crank', 'ground']", "2 entries"},
    {"ragged_table", PIN "[[drive]]\nof = 'pin.angle'\ntype = 'table'\npoints = [[0, 0], [1, 1], [2]]\n",
     Code::wrong_count, 13, "[2]", "2 entries, not 1"},
    {"infinite", PIN "at = [inf, 0, 0]\n", Code::not_finite, 10, "inf", "finite"},
    {"division_by_zero", PIN "at = ['1/0', 0, 0]\n", Code::not_finite, 10, "1/0", "finite"},
    {"root_of_a_negative", PIN "at = ['sqrt(-1)', 0, 0]\n", Code::not_finite, 10, "sqrt(-1)", "finite"},
    {"negative_mass", BODIES "mass = -1\n", Code::out_of_range, 6, "-1", "at least 0 kg"},
    {"no_length_at_all", "schema = 1\n[scene]\nlength = 0\n", Code::out_of_range, 3, "0", "greater than 0"},
    {"no_steps", "schema = 1\n[scene]\nsteps = 0\n", Code::out_of_range, 3, "0", "greater than 0"},
    {"turn_about_w", BODIES "rotate = [['w', 1]]\n", Code::out_of_range, 6, "'w'", "`axis`"},
    {"zero_axis", PIN "axis = [0, 0, 0]\n", Code::zero_direction, 10, "[0, 0, 0]", "any length but zero"},
    {"zero_quaternion", BODIES "quaternion = [0, 0, 0, 0]\n", Code::zero_direction, 6, "[0, 0, 0, 0]", "[1, 0, 0, 0]"},
    {"parallel_axes", PIN "axis = [0, 0, 2]\nx_axis = [0, 0, 1]\n", Code::zero_direction, 11, "[0, 0, 1]", "parallel"},
    {"zero_second_axis",
     BODIES "[[joint]]\nname = 'j'\ntype = 'universal'\nbetween = ['ground', 'rod']\naxis2 = [0, 0, 0]\n",
     Code::zero_direction, 10, "[0, 0, 0]", "direction"},
    {"zero_start", BALL "start = { rotation = [0, 0, 0, 0] }\n", Code::zero_direction, 10, "[0, 0, 0, 0]", "rotation"},
    {"driven_twice", DRIVE "[[drive]]\nof = 'pin.angle'\ntype = 'constant'\nvalue = 1\n", Code::driven_twice, 16,
     "'pin.angle'", "line 10"},
    {"drive_of_a_quaternion", BALL "[[drive]]\nof = 'ball.rotation'\ntype = 'constant'\nvalue = 1\n", Code::not_scalar,
     11, "'ball.rotation'", "chain of revolutes or a universal joint"},
    {"limits_of_a_quaternion", BALL "limits = { rotation = [0, 1] }\n", Code::not_scalar, 10, "[0, 1]", "`rotation`"},
    {"zero_of_a_quaternion", BALL "zero = { rotation = 1 }\n", Code::not_scalar, 10, "1", "`rotation`"},
    {"limits_upside_down", PIN "limits = { angle = ['30 deg', '-30 deg'] }\n", Code::bad_limits, 10,
     "['30 deg', '-30 deg']", "[lower, upper]"},
    {"parameter_cycle", "schema = 1\n[parameters]\na = 'b'\nb = '2*c'\nc = 'b + 1'\n[scene]\nlength = 'a'\n",
     Code::parameter_cycle, 4, "'2*c'", "`b` needs `c` needs `b`"},
    {"parameter_needs_itself", "schema = 1\n[parameters]\na = 'a + 1'\n[scene]\nlength = 'a'\n", Code::parameter_cycle,
     3, "'a + 1'", "`a` needs `a`"},
    // Files
    {"include_without_folder", "schema = 1\n[[include]]\nfile = 'other.toml'\n", Code::file_unreadable, 3,
     "'other.toml'", "folder"},
    {"include_without_file", "schema = 1\n[[include]]\nprefix = 'left'\n", Code::missing_key, 2, "[[include]]", "file"},
};

class FaultyScene : public testing::TestWithParam<Fault> {};

TEST_P(FaultyScene, has_one_error_at_its_place) {
  const Fault& fault = GetParam();
  SceneReader reader;
  EXPECT_FALSE(reader.read(fault.text));
  const auto errors = reader.of(Severity::error);
  ASSERT_EQ(errors.size(), 1u) << reader.diagnostics.render();
  const Error& error = errors.front();
  const std::string shown = render(error);
  EXPECT_EQ(error.code, fault.code) << shown;
  EXPECT_EQ(error.source.line, fault.line) << shown;
  EXPECT_GT(error.source.column, 0) << shown;
  if (*fault.marked != '\0') {
    EXPECT_EQ(marked(error), fault.marked) << shown;
  }
  EXPECT_NE((error.message + '\n' + error.advice).find(fault.says), std::string::npos) << shown;
}

INSTANTIATE_TEST_SUITE_P(scene, FaultyScene, testing::ValuesIn(faults),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(Findings, come_together_in_the_order_of_the_text) {
  SceneReader reader;
  ASSERT_FALSE(
      reader.read("schema = 1\n"
                  "[[joint]]\n"
                  "name = 'pin'\n"
                  "type = 'revolut'\n"
                  "between = ['ground', 'krank']\n"
                  "axis = [0, 0, 0]\n"
                  "[[body]]\n"
                  "name = 'crank'\n"
                  "mas = 3\n"
                  "mass = '2*'\n"
                  "[[drive]]\n"
                  "of = 'pin.angle'\n"
                  "[scene]\n"
                  "gravity = 9.81\n"));
  std::vector<std::pair<int, Code>> found;
  for (const Error& error : reader.of(Severity::error)) found.emplace_back(error.source.line, error.code);
  // Of the drive only its own fault: that its joint is unknown follows from the fault of the joint.
  const std::vector<std::pair<int, Code>> expected = {
      {4, Code::unknown_type},    {5, Code::unknown_body}, {6, Code::zero_direction}, {9, Code::unknown_key},
      {10, Code::bad_expression}, {11, Code::missing_key}, {14, Code::wrong_kind}};
  EXPECT_EQ(found, expected) << reader.diagnostics.render();
}

/// What is marked, with the advice, of all errors of a code.
std::vector<std::pair<std::string, std::string>> advice_of(const SceneReader& reader, Code code) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Error& error : reader.of(Severity::error)) {
    if (error.code == code) out.emplace_back(marked(error), error.advice);
  }
  return out;
}

TEST(Findings, tell_of_misspelt_keys_where_the_type_is_missing) {
  using Advice = std::vector<std::pair<std::string, std::string>>;
  SceneReader reader;
  ASSERT_FALSE(
      reader.read(BODIES "[[joint]]\nname = 'j'\ntyp = 'helical'\nbetwen = ['ground', 'rod']\npitch = 1\nstat = {}\n"));
  EXPECT_EQ(advice_of(reader, Code::unknown_key), (Advice{{"typ", "did you mean `type`?"},
                                                          {"betwen", "did you mean `between`?"},
                                                          {"stat", "did you mean `start`?"}}));
  ASSERT_FALSE(reader.read(PIN "[[drive]]\nfo = 'pin.angle'\ntyp = 'constant'\nvalue = 1\n"));
  EXPECT_EQ(advice_of(reader, Code::unknown_key),
            (Advice{{"fo", "did you mean `of`?"}, {"typ", "did you mean `type`?"}}));
  ASSERT_FALSE(reader.read("schema = 1\n[[constraint]]\nname = 'c'\ntyp = 'distance'\ndistance = 1\n"));
  EXPECT_EQ(advice_of(reader, Code::unknown_key), (Advice{{"typ", "did you mean `type`?"}}));
  ASSERT_FALSE(reader.read("schema = 1\n[[body]]\nname = 'b'\ntype = 'rigd'\nmass = 1\nrotat = []\n"));
  EXPECT_EQ(advice_of(reader, Code::unknown_key), (Advice{{"rotat", "did you mean `rotate`?"}}));
}

TEST(Findings, name_the_element) {
  SceneReader reader;
  ASSERT_FALSE(reader.read(PIN "axis = [0, 0]\n"));
  EXPECT_EQ(reader.diagnostics.first_error().element, "joint pin");
}

TEST(Findings, mark_bytes_where_letters_take_several) {
  SceneReader reader;
  ASSERT_FALSE(reader.read("schema = 1\n[scene]\ntitle = 'Räder'\ngravity = [0, 0, '3*größe'] # ä\n"));
  const Error& error = reader.diagnostics.first_error();
  EXPECT_EQ(error.source.line, 4);
  EXPECT_EQ(marked(error).substr(0, 2), "gr");
}

TEST(Findings, show_what_render_draws) {
  SceneReader reader;
  ASSERT_FALSE(reader.read(PIN "axs = [0, 1, 0]\n"));
  EXPECT_EQ(reader.diagnostics.render(),
            "scene:10:1: error[E0201]: joint pin: `axs` is not known here\n"
            "  10 | axs = [0, 1, 0]\n"
            "     | ^~~\n"
            "  help: did you mean `axis`?\n");
}

TEST(Findings, tell_of_a_missing_plugin_once) {
  SceneReader reader;
  ASSERT_FALSE(
      reader.read(BODIES "[[joint]]\nname = 'i'\ntype = 'acme.cam'\nplugin = 'acme.so'\nbetween = ['ground', 'rod']\n"
                         "[[joint]]\nname = 'j'\ntype = 'acme.cam'\nplugin = 'acme.so'\nbetween = ['crank', 'rod']\n"));
  EXPECT_EQ(reader.of(Severity::error).size(), 1u) << reader.diagnostics.render();
}

TEST(Findings, warn_of_an_unused_parameter) {
  SceneReader reader;
  reader.good("schema = 1\n[parameters]\na = 1\nb = '2*a'\n");
  const auto warnings = reader.of(Severity::warning);
  ASSERT_EQ(warnings.size(), 1u) << reader.diagnostics.render();
  EXPECT_EQ(warnings[0].code, Code::unused_parameter);
  EXPECT_EQ(marked(warnings[0]), "b");
}

TEST(Findings, warn_of_a_start_that_a_drive_overrules) {
  SceneReader reader;
  reader.good(PIN
              "start = { angle = 1 }\n[[drive]]\nof = 'pin.angle'\ntype = 'constant'\nvalue = 1\n"
              "[[joint]]\nname = 'q'\ntype = 'revolute'\nbetween = ['crank', 'rod']\nstart = { angle = 1 }\n");
  const auto warnings = reader.of(Severity::warning);
  ASSERT_EQ(warnings.size(), 1u) << reader.diagnostics.render();
  EXPECT_EQ(warnings[0].code, Code::start_ignored);
  EXPECT_EQ(warnings[0].source.line, 10);
}

TEST(Findings, warn_of_a_start_rate_that_a_drive_overrides) {
  SceneReader reader;
  reader.good(PIN
              "start_rate = { angle = 1 }\n[[drive]]\nof = 'pin.angle'\ntype = 'constant'\nvalue = 1\n"
              "[[joint]]\nname = 'q'\ntype = 'revolute'\nbetween = ['crank', 'rod']\nstart_rate = { angle = 1 }\n");
  const auto warnings = reader.of(Severity::warning);
  ASSERT_EQ(warnings.size(), 1u) << reader.diagnostics.render();
  EXPECT_EQ(warnings[0].code, Code::start_ignored);
  EXPECT_EQ(warnings[0].source.line, 10);
  EXPECT_NE(warnings[0].message.find("start rate"), std::string::npos);
}

TEST(Findings, tell_of_files_that_cannot_be_read) {
  SceneReader reader;
  const auto missing = reader.read_file("/nonexistent/scene.toml");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::file_unreadable);
  const auto folder = reader.read_file(std::filesystem::temp_directory_path());
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, Code::file_unreadable);
}

}  // namespace
}  // namespace koppel
