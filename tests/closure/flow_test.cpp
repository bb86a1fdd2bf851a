// The solution flow: for the mechanisms of the books it is the one that the books give; every step has what it needs
// when its turn comes; and neither names nor order nor place nor makers of joints change it.
#include "closure/flow.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "../mechanism/built.hpp"
#include "../scenes/rewriting.hpp"
#include "closure/modes.hpp"
#include "folders.hpp"

namespace koppel::test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// Places of the inputs in a text, changed.
using Changes = std::vector<std::pair<std::string, std::string>>;

/// The text of a shipped scene, changed here and there.
std::string scene(const std::string& name, const Changes& changes = {}) {
  std::ifstream file(std::filesystem::path(scenes_folder()) / (name + ".toml"));
  std::ostringstream text;
  text << file.rdbuf();
  std::string result = text.str().substr(text.str().find("schema"));
  for (const auto& [old, with] : changes) result = replaced(result, old, with);
  return result;
}

/// The scene without its drives, with coordinates that are held at these values instead.
std::string driven(const std::string& name, const std::map<std::string, std::string>& values,
                   const Changes& changes = {}) {
  toml::table root = toml::parse(scene(name, changes));
  toml::array drives;
  for (const auto& [coordinate, value] : values) {
    drives.push_back(toml::table{{"of", coordinate}, {"type", "constant"}, {"value", value}});
  }
  root.insert_or_assign("drive", drives);
  root.erase("record");
  std::ostringstream text;
  text << root;
  return text.str();
}

const std::vector<std::string>& scenes() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> found;
    for (const auto& file : std::filesystem::directory_iterator(scenes_folder())) {
      if (file.path().extension() == ".toml") found.push_back(file.path().stem().string());
    }
    std::sort(found.begin(), found.end());
    return found;
  }();
  return names;
}

/// A text that starts with its schema, as written by a table whose keys are sorted.
std::string in_order(std::string text) {
  const std::string schema = "schema = 1\n";
  const std::size_t at = text.find(schema);
  return schema + (at == std::string::npos ? text : text.erase(at, schema.size()));
}

/// A mechanism and its flow, with words for both.
struct Planned {
  explicit Planned(const std::string& text) : built(in_order(text)), flow(plan_flow(*built)) {}

  /// "crank.angle", of a ball "joint"; of an imaginary joint "pose 0" and so on.
  std::string name(std::uint32_t variable) const {
    const Variable& v = flow.loops.variables[variable];
    if (v.joint.index() >= built->joints.size()) {
      const auto first = std::find_if(flow.loops.variables.begin(), flow.loops.variables.end(),
                                      [&](const Variable& other) { return other.joint == v.joint; });
      return std::string("pose ") + std::to_string(variable - (first - flow.loops.variables.begin()));
    }
    if (v.kind == VariableKind::ball) return built->joints[v.joint.index()].name;
    return built->coordinate_names[v.q].name;
  }
  std::set<std::string> names(const std::vector<std::uint32_t>& variables) const {
    std::set<std::string> result;
    for (const std::uint32_t v : variables) result.insert(name(v));
    return result;
  }
  /// The pair at which a step's loop is cut, and the conditions it takes: "S-T 1".
  std::string conditions(const FlowStep& step) const {
    static const char* const letters[] = {"R", "P", "C", "T", "S", "E", "E_R", "E_P"};
    std::string result;
    for (const FlowRow& row : step.rows) {
      const LoopCut& cut = flow.cuts[row.cut];
      std::string pair = letters[static_cast<std::size_t>(cut.a.shape)];
      if (cut.b) pair.append("-").append(letters[static_cast<std::size_t>(cut.b->shape)]);
      if (result.rfind(pair, 0) != 0) result += (result.empty() ? "" : ", ") + pair;
      result += std::string(" ") + std::to_string(static_cast<int>(cut.conditions[row.condition].type));
    }
    return result;
  }

  Built built;
  Flow flow;
};

// ------------------------------------------------------------------ the flows of the books

struct Step {
  StepKind kind;
  std::set<std::string> unknowns, given;
  std::string conditions;
  bool operator==(const Step&) const = default;
};

void PrintTo(const Step& step, std::ostream* out) {
  *out << static_cast<int>(step.kind) << ":";
  for (const std::string& name : step.unknowns) *out << ' ' << name;
  *out << " from";
  for (const std::string& name : step.given) *out << ' ' << name;
  *out << " by " << step.conditions;
}

/// The steps that other loops need, in order; those of a pair's own coordinates are left out.
std::vector<Step> core(const Planned& planned) {
  std::vector<Step> steps;
  for (const FlowStep& step : planned.flow.steps) {
    if (step.only_here) continue;
    steps.push_back({step.kind, planned.names(step.unknowns), planned.names(step.given), planned.conditions(step)});
  }
  return steps;
}

/// Whether the core is these steps, in any order that the steps allow.
void expect_core(const std::string& text, const std::vector<Step>& wanted) {
  const Planned planned(text);
  EXPECT_EQ(planned.flow.obstacle, "");
  EXPECT_TRUE(planned.flow.held.empty());
  const std::vector<Step> found = core(planned);
  EXPECT_EQ(found.size(), wanted.size());
  for (const Step& step : wanted) {
    EXPECT_TRUE(std::find(found.begin(), found.end(), step) != found.end())
        << testing::PrintToString(step) << " is not in " << testing::PrintToString(found);
  }
}

constexpr StepKind one = StepKind::one_unknown, two = StepKind::two_unknowns;

TEST(Flow, OfTheSpatialFourBarIsOneConditionOfTypeOne) {
  expect_core(scene("rstr"), {{one, {"rocker.angle"}, {"crank.angle"}, "S-T 1"}});
}

TEST(Flow, OfBallAndCylinderIsOneConditionOfTypeThree) {
  expect_core(scene("rscr"), {{one, {"rocker.angle"}, {"crank.angle"}, "S-C 3"}});
}

TEST(Flow, OfThreeCylindersIsAnAngleAndThenADistance) {
  expect_core(scene("rccc"), {{one, {"joint4.angle"}, {"crank.angle"}, "C-C 4"},
                              {one, {"joint4.displacement"}, {"crank.angle", "joint4.angle"}, "C-C 5"}});
}

TEST(Flow, OfTheDriveLinkIsOneConditionOfTypeTwo) {
  expect_core(scene("drive"), {{one, {"plate.angle"}, {"ring.angle"}, "S-E_R 2"}});
}

TEST(Flow, OfSixJointsIsOneConditionInTheLastAngle) {
  expect_core(scene("6joint"), {{one, {"arm2.angle"}, {"arm1.angle", "base1.angle", "base2.angle"}, "S-T 1"}});
}

Step bell_crank(const std::string& to, const std::string& from) { return {one, {to}, {from}, "R-R 1"}; }

TEST(Flow, GoesFromBellCrankToBellCrank) {
  expect_core(scene("chain"), {bell_crank("bell2.angle", "bell1.angle"), bell_crank("bell3.angle", "bell2.angle"),
                               bell_crank("bell4.angle", "bell2.angle"), bell_crank("bell5.angle", "bell4.angle")});
}

// Of the last loops it gives any angle: nobody else needs the bell cranks.
TEST(Flow, GoesTheOtherWayFromTheOtherEnd) {
  const Planned planned(driven("chain", {{"bell5.angle", "66.3 deg"}}));
  EXPECT_TRUE(planned.flow.in_closed_form());
  const std::vector<Step> found = core(planned);
  ASSERT_EQ(found.size(), 4u) << testing::PrintToString(found);
  EXPECT_EQ(found[0], bell_crank("bell4.angle", "bell5.angle"));
  for (std::size_t i = 1; i < 4; ++i) {
    const bool on = found[i] == bell_crank("bell2.angle", "bell4.angle");
    EXPECT_TRUE(on || (found[i].given == std::set<std::string>{"bell2.angle"} && found[i].conditions == "R-R 1"));
  }
}

TEST(Flow, OfLoopsInARowIsRecursive) {
  const Planned planned(scene("7b10j"));
  EXPECT_TRUE(planned.flow.in_closed_form());
  std::vector<Step> wanted{bell_crank("rocker.angle", "crank.angle"),
                           bell_crank("rocker_link5.angle", "rocker_pin.angle"),
                           {one, {"link7.angle"}, {"rocker.angle", "rocker_link5.angle"}, "R-R 1"}};
  const std::vector<Step> found = core(planned);
  for (const Step& step : wanted) {
    EXPECT_TRUE(std::find(found.begin(), found.end(), step) != found.end()) << testing::PrintToString(found);
  }
  EXPECT_EQ(found.size(), 4u) << "and the angle between rocker and coupler, which is no bell crank";
}

TEST(Flow, GoesThroughADoubleJoint) {
  expect_core(scene("9body"), {bell_crank("d.angle", "b.angle"),
                               bell_crank("f.angle", "b.angle"),
                               bell_crank("i.angle", "f.angle"),
                               {one, {"i_k.angle"}, {"d.angle", "i.angle"}, "R-R 1"}});
}

// From the far angle no loop can be solved by itself: all angles at the ground are unknown together.
TEST(Flow, IsSimultaneousWhereNothingIsKnownByItself) {
  const Planned planned(driven("9body", {{"k_j.angle", "107.7 deg"}}));
  EXPECT_EQ(planned.flow.obstacle, "");
  std::set<std::string> together;
  for (const FlowStep& step : planned.flow.steps) {
    if (step.kind == StepKind::numerical) together.merge(planned.names(step.unknowns));
  }
  for (const std::string angle : {"b.angle", "d.angle", "f.angle", "i.angle"}) {
    EXPECT_TRUE(together.contains(angle)) << angle << " is not in " << testing::PrintToString(together);
  }
}

TEST(Flow, OfTheSwashPlateIsOneLeverAfterTheOther) {
  // The plate turns about the axis on which the second ball lies.
  expect_core(scene("swash"), {{one, {"lever1.angle"}, {"plate.angle", "ring.angle", "slider.displacement"}, "S-T 1"},
                               {one, {"lever2.angle"}, {"ring.angle", "slider.displacement"}, "S-T 1"}});
}

const std::map<std::string, std::string> levers{
    {"slider.displacement", "10 mm"}, {"lever1.angle", "17.815749943 deg"}, {"lever2.angle", "23.609707788 deg"}};

// The plate turns about the axis on which the second ball lies, so that the second lever alone tells the ring.
TEST(Flow, OfTheSwashPlateFromItsLeversIsRingAndThenPlate) {
  expect_core(driven("swash", levers),
              {{one, {"ring.angle"}, {"lever2.angle", "slider.displacement"}, "S-T 1"},
               {one, {"plate.angle"}, {"lever1.angle", "ring.angle", "slider.displacement"}, "S-T 1"}});
}

TEST(Flow, OfATurnedSwashPlateFromItsLeversIsBothTiltsTogether) {
  const std::string axis = "at = [0, 0, 0]\naxis = [0, 1, 0]";  // of the plate
  const Planned planned(driven("swash", levers, {{axis, "at = [0, 0, 0]\naxis = [0.3, 1, 0]"}}));
  const Step first = core(planned).front();
  EXPECT_EQ(first.kind, two);
  EXPECT_EQ(first.unknowns, (std::set<std::string>{"plate.angle", "ring.angle"}));
  EXPECT_EQ(first.given, (std::set<std::string>{"lever1.angle", "lever2.angle", "slider.displacement"}));
}

// ------------------------------------------------------------------ every flow

class FlowOfAScene : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Closure, FlowOfAScene, testing::ValuesIn(scenes()),
                         [](const auto& test) { return std::string("scene_") + test.param; });

/// Planned once: most tests only look.
const Planned& shipped(const std::string& name) {
  static std::map<std::string, Planned> all;
  return all.try_emplace(name, scene(name)).first->second;
}

TEST_P(FlowOfAScene, KnowsEverythingBeforeItNeedsIt) {
  const Planned& planned = shipped(GetParam());
  const Flow& flow = planned.flow;
  if (!flow.obstacle.empty()) {
    EXPECT_TRUE(flow.steps.empty());
    return;
  }
  std::set<std::uint32_t> known(flow.inputs.begin(), flow.inputs.end());
  known.insert(flow.held.begin(), flow.held.end());
  for (const FlowStep& step : flow.steps) {
    for (const std::uint32_t v : step.given) EXPECT_TRUE(known.contains(v)) << planned.name(v);
    for (const std::uint32_t v : step.unknowns) {
      EXPECT_TRUE(known.insert(v).second) << planned.name(v) << " is known already";
    }
  }
  known.insert(flow.outside.begin(), flow.outside.end());
  EXPECT_EQ(known.size(), flow.loops.variables.size()) << "every coordinate is given, held, found or outside";
}

TEST_P(FlowOfAScene, LeavesOutOnlyWhatNobodyElseNeeds) {
  const Planned& planned = shipped(GetParam());
  std::set<std::uint32_t> left_out;
  for (const FlowStep& step : planned.flow.steps) {
    if (step.only_here) {
      left_out.insert(step.unknowns.begin(), step.unknowns.end());
      continue;
    }
    for (const std::uint32_t v : step.given) EXPECT_FALSE(left_out.contains(v)) << planned.name(v);
  }
}

/// Places at random, with one variable moved on.
koppel::Place<double> place_at_random(VariableKind kind, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  if (kind == VariableKind::turn) return {std::cos(x), std::sin(x), 0, 0};
  if (kind == VariableKind::slide) return {x, 0, 0, 0};
  const Vector4 q = Vector4(x, normal(random), normal(random), normal(random)).normalized();
  return {q[0], q[1], q[2], q[3]};
}

// The value of a condition does not change when something moves that the step neither seeks nor is given. Walks have up
// to 20 motions, each worth two products of poses, and lengths of a few of the mechanism's.
TEST_P(FlowOfAScene, HasConditionsInNothingElse) {
  const Planned& planned = shipped(GetParam());
  const Flow& flow = planned.flow;
  std::mt19937_64 random(1);
  for (const FlowStep& step : flow.steps) {
    std::vector<koppel::Place<double>> at;
    for (const Variable& v : flow.loops.variables) {
      at.push_back(place_at_random(v.kind, random));
      if (v.kind == VariableKind::slide) at.back()[0] *= flow.length;
    }
    for (const FlowRow& row : step.rows) {
      const LoopCut& cut = flow.cuts[row.cut];
      const Loop& loop = flow.loops.loops[cut.loop];
      const Way lower = lower_way(loop, flow.loops.variables, cut), upper = upper_way(loop, flow.loops.variables, cut);
      const auto open = [&] { return openness(cut.conditions[row.condition], lower, upper, at, flow.length); };
      const double before = open(), allowed = 20 * 2 * 6 * eps * 100;
      int changed = 0;
      for (std::uint32_t v = 0; v < at.size(); ++v) {
        const koppel::Place<double> here = std::exchange(at[v], place_at_random(flow.loops.variables[v].kind, random));
        const bool seeks = std::binary_search(step.unknowns.begin(), step.unknowns.end(), v);
        if (!seeks && !std::binary_search(step.given.begin(), step.given.end(), v)) {
          EXPECT_NEAR(open(), before, allowed) << planned.name(v);
        }
        changed += seeks && std::abs(open() - before) > allowed ? 1 : 0;
        at[v] = here;
      }
      EXPECT_GT(changed, 0) << planned.conditions(step) << ": some unknown enters";
    }
  }
}

TEST_P(FlowOfAScene, HasAsManyConditionsAsUnknowns) {
  const Planned& planned = shipped(GetParam());
  for (const FlowStep& step : planned.flow.steps) {
    const bool ball =
        step.unknowns.size() == 1 && planned.flow.loops.variables[step.unknowns[0]].kind == VariableKind::ball;
    switch (step.kind) {
      case StepKind::one_unknown:
        EXPECT_EQ(step.unknowns.size(), 1u);
        EXPECT_FALSE(ball);
        EXPECT_GE(step.rows.size(), 1u);
        break;
      case StepKind::two_unknowns:
        EXPECT_EQ(step.unknowns.size(), 2u);
        EXPECT_EQ(step.rows.size(), 2u);
        break;
      case StepKind::joint:
      case StepKind::spin:
        EXPECT_TRUE(step.rows.empty());
        EXPECT_EQ(step.loops.size(), 1u);
        EXPECT_TRUE(step.kind == StepKind::joint || ball);
        break;
      case StepKind::numerical: EXPECT_FALSE(step.rows.empty() && step.whole_loops.empty()); break;
    }
  }
}

// ------------------------------------------------------------------ what must not matter

/// A step that is the same in a scene and in its rewriting: kind, unknowns, whether others need it.
using Same = std::tuple<int, std::set<std::string>, bool>;

/// How a name of the rewriting is called in the original.
using Back = std::function<std::string(const std::string&)>;

/// Of several cuts that are equally good the one is taken that comes first on the walk round the loop. Where the order
/// of the file turns the walk round, another unknown may take the place of the first, as both ends of a four-bar may.
enum class Choices { same, equal };

std::multiset<Same> steps_of(const Planned& planned, const Back& back, Choices choices) {
  std::multiset<Same> steps;
  for (const FlowStep& step : planned.flow.steps) {
    std::set<std::string> unknowns;
    for (const std::uint32_t v : step.unknowns) {
      const bool ball = planned.flow.loops.variables[v].kind == VariableKind::ball;
      const std::string any = (ball ? "any ball " : "any ") + std::to_string(unknowns.size());
      unknowns.insert(choices == Choices::same ? back(planned.name(v)) : any);
    }
    steps.emplace(static_cast<int>(step.kind), unknowns, step.only_here);
  }
  return steps;
}

/// All modes as coordinates of the original scene. Angles count within one turn.
struct Positions {
  std::vector<Eigen::VectorXd> q;
  bool complete = false;
};

Positions positions_of(const Built& built) {
  Work work(built.mechanism);
  State state(*built.mechanism);
  EXPECT_EQ(set_time(*built.mechanism, 0.0, state), nullptr);
  Modes modes;
  ModeOptions options;
  options.all_twins = true;  // so that none is chosen
  EXPECT_TRUE(find_modes(work, state, options, modes));
  Positions positions;
  positions.complete = modes.complete;
  for (const Mode& mode : modes.modes) positions.q.push_back(mode.q);
  return positions;
}

/// Coordinates of a joint that is passed the other way round.
void turn_round(const Joint& joint, double* q) {
  if (joint.nq == 2 && joint.blocks[0].kind == BlockKind::angle && joint.blocks[1].kind == BlockKind::angle) {
    std::swap(q[0], q[1]);  // a Cardan joint
  }
  if (joint.blocks.size() == 1 && joint.blocks[0].kind == BlockKind::quaternion) {
    for (int i = 1; i < 4; ++i) q[i] = -q[i];
  } else {
    for (std::uint32_t i = 0; i < joint.nq; ++i) q[i] = -q[i];
  }
}

/// The rewriting's position in coordinates of the original. `name`: what the original's joint is called there.
Eigen::VectorXd translated(const Built& original, const Built& other, const Eigen::VectorXd& q, const Back& name) {
  Eigen::VectorXd result(q.size());
  for (const Joint& joint : original->joints) {
    const Joint& twin = other.joint(name(joint.name));
    for (std::uint32_t i = 0; i < joint.nq; ++i) result[joint.q + i] = q[twin.q + i];
    const auto body = [](const Built& built, const Joint& of) { return built->bodies[of.inlet.body.index()].name; };
    const bool renamed = name(joint.name) != joint.name;  // and then not turned round
    if (!renamed && body(original, joint) != body(other, twin)) turn_round(joint, result.data() + joint.q);
  }
  return result;
}

/// How far two positions are apart: angles within a turn, quaternions up to their sign.
double apart(const Mechanism& mechanism, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double most = 0.0;
  for (const StateBlock& block : mechanism.blocks) {
    if (block.kind == BlockKind::quaternion) {
      const Vector4 p = a.segment<4>(block.q), q = b.segment<4>(block.q);
      most = std::max(most, std::min((p - q).norm(), (p + q).norm()));
    } else {
      const double d = a[block.q] - b[block.q];
      most = std::max(most, std::abs(block.kind == BlockKind::angle ? std::remainder(d, 2 * std::numbers::pi) : d));
    }
  }
  return most;
}

struct SameFlow : testing::TestWithParam<std::string> {
  const std::string text = scene(GetParam());
  const Planned& original = shipped(GetParam());
  const Positions modes = original.flow.in_closed_form() ? positions_of(original.built) : Positions{};

  /// name: of a joint of the original in the other scene; back: of a coordinate of the other scene in the original.
  void expect_same(const std::string& other_text, const Back& name, const Back& back, Choices choices) {
    const Planned other(other_text);
    EXPECT_EQ(other.flow.obstacle.empty(), original.flow.obstacle.empty());
    const auto none = [](const std::string& same) { return same; };
    const std::multiset<Same> ours = steps_of(original, none, choices), theirs = steps_of(other, back, choices);
    std::vector<Same> only_ours, only_theirs;
    std::set_difference(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(only_ours));
    std::set_difference(theirs.begin(), theirs.end(), ours.begin(), ours.end(), std::back_inserter(only_theirs));
    EXPECT_EQ(only_theirs, only_ours) << "steps (kind, unknowns, needed only here) that the other has not";
    if (original.flow.in_closed_form()) expect_same_modes(other, name);
  }
  void expect_same_modes(const Planned& other, const Back& name) {
    const Positions found = positions_of(other.built);
    EXPECT_EQ(found.q.size(), modes.q.size());
    EXPECT_EQ(found.complete, modes.complete);
    for (const Eigen::VectorXd& q : found.q) {
      const Eigen::VectorXd here = translated(original.built, other.built, q, name);
      double nearest = 1e300;
      for (const Eigen::VectorXd& mode : modes.q) nearest = std::min(nearest, apart(*original.built, mode, here));
      EXPECT_LE(nearest, 1e-10) << "a mode that the original has not";
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Closure, SameFlow, testing::ValuesIn(scenes()),
                         [](const auto& test) { return std::string("scene_") + test.param; });

const Back unchanged = [](const std::string& name) { return name; };

TEST_P(SameFlow, WhenRenamed) {
  Random random(1);
  Rewriting rewriting(text);
  rewriting.rename(random);
  const Built other(in_order(rewriting.text()));
  std::map<std::string, std::string> names, back;
  for (std::size_t i = 0; i < other->joints.size(); ++i) {  // the order is the same
    names[original.built->joints[i].name] = other->joints[i].name;
    back[other->joints[i].name] = original.built->joints[i].name;
  }
  for (std::size_t i = 0; i < other->coordinate_names.size(); ++i) {
    back[other->coordinate_names[i].name] = original.built->coordinate_names[i].name;
  }
  const auto in = [](const std::map<std::string, std::string>& map) {
    return [&map](const std::string& name) {
      const auto found = map.find(name);
      return found == map.end() ? name : found->second;  // an imaginary joint has no name
    };
  };
  expect_same(rewriting.text(), in(names), in(back), Choices::same);
}

TEST_P(SameFlow, WhenReordered) {
  for (const std::uint64_t seed : {1, 2}) {
    Random random(seed);
    Rewriting rewriting(text);
    rewriting.reorder(random);
    expect_same(rewriting.text(), unchanged, unchanged, Choices::equal);
  }
}

TEST_P(SameFlow, WithInletsAndOutletsSwapped) {
  for (const std::uint64_t seed : {1, 2}) {
    Random random(seed);
    Rewriting rewriting(text);
    rewriting.swap_joints(random);
    expect_same(rewriting.text(), unchanged, unchanged, Choices::equal);
  }
}

TEST_P(SameFlow, AnywhereInTheWorld) {
  if (GetParam() == "7r") GTEST_SKIP() << "its frames are given by quaternions, which rewriting does not turn";
  for (const std::uint64_t seed : {1, 2}) {
    Random random(seed);
    Rewriting rewriting(text);
    rewriting.relocate(random_place(random));
    expect_same(rewriting.text(), unchanged, unchanged, Choices::same);
  }
}

TEST_P(SameFlow, WithAStrangersJoints) {
  Rewriting rewriting(text);
  rewriting.change_vendor("acme");
  expect_same(rewriting.text(), unchanged, unchanged, Choices::same);
}

// ------------------------------------------------------------------ what the flow finds

TEST(Flow, FindsTheTiltsOfTheSwashPlateFromItsLevers) {
  const Planned planned(driven("swash", levers));
  const Positions modes = positions_of(planned.built);
  EXPECT_TRUE(modes.complete);
  // The levers are given to 1e-9 degrees, which the tilts take over: they are of the same size.
  EXPECT_TRUE(std::any_of(modes.q.begin(), modes.q.end(), [&](const Eigen::VectorXd& q) {
    const auto at = [&](const std::string& name) { return q[planned.built.coordinate(name)] / degree; };
    return std::abs(at("ring.angle") - 5) < 1e-8 && std::abs(at("plate.angle") + 3) < 1e-8;
  }));
}

}  // namespace
}  // namespace koppel::test
