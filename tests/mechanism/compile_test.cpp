// From scene to mechanism: names, units, length, where loops are cut, what is counted.
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "built.hpp"
#include "folders.hpp"

namespace koppel::test {
namespace {

/// A planar four-bar of unit links; `more` goes to its end.
std::string four_bar(const std::string& more = {}) {
  return std::string(
             "[[body]]\nname = 'crank'\n[[body]]\nname = 'coupler'\n[[body]]\nname = 'rocker'\n"
             "[[joint]]\nname = 'a'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'crank'\n"
             "[[joint]]\nname = 'b'\ntype = 'revolute'\ninlet = { on = 'crank', at = [0.5, 0, 0] }\noutlet = "
             "'coupler'\n"
             "[[joint]]\nname = 'c'\ntype = 'revolute'\ninlet = { on = 'coupler', at = [2, 0, 0] }\noutlet = 'rocker'\n"
             "[[joint]]\nname = 'd'\ntype = 'revolute'\ninlet = { on = 'rocker', at = [1, 0, 0] }\n"
             "outlet = { on = 'ground', at = [1.7, 0, 0] }\n") +
         more;
}

std::string driven(const std::string& coordinate) {
  return "[[drive]]\nof = '" + coordinate + "'\ntype = 'constant'\nvalue = 0\n";
}

TEST(Compile, NamesCoordinatesAndTheirRates) {
  const Built built(single_joint("type = 'free'"));
  std::map<std::string, std::string> q, v;
  for (const NamedNumber& number : built->coordinate_names) q[number.name] = number.unit;
  for (const NamedNumber& number : built->rate_names) v[number.name] = number.unit;
  EXPECT_EQ(q, (std::map<std::string, std::string>{{"joint.rotation.w", "1"},
                                                   {"joint.rotation.x", "1"},
                                                   {"joint.rotation.y", "1"},
                                                   {"joint.rotation.z", "1"},
                                                   {"joint.x", "m"},
                                                   {"joint.y", "m"},
                                                   {"joint.z", "m"}}));
  EXPECT_EQ(v, (std::map<std::string, std::string>{{"joint.rotation.x", "rad/s"},
                                                   {"joint.rotation.y", "rad/s"},
                                                   {"joint.rotation.z", "rad/s"},
                                                   {"joint.x", "m/s"},
                                                   {"joint.y", "m/s"},
                                                   {"joint.z", "m/s"}}));
}

TEST(Compile, TakesTheLargestDistanceOnABodyAsLength) {
  EXPECT_EQ(Built(four_bar())->length, 2.0);
  EXPECT_EQ(Built("[scene]\nlength = 0.4\n" + four_bar())->length, 0.4);
}

TEST(Compile, LengthIsNotThatOfAGroundWithManySmallMechanisms) {
  const auto bar = [](const std::string& n, double x) {
    return "[[body]]\nname = 'bar" + n + "'\n[[joint]]\nname = 'a" + n + "'\ntype = 'revolute'\noutlet = 'bar" + n +
           "'\ninlet = { on = 'ground', at = [" + std::to_string(x) + ", 0, 0] }\n[[body]]\nname = 'tip" + n +
           "'\n[[joint]]\nname = 'b" + n + "'\ntype = 'revolute'\ninlet = { on = 'bar" + n +
           "', at = [0.5, 0, 0] }\noutlet = 'tip" + n + "'\n";
  };
  EXPECT_EQ(Built(bar("1", 0.0) + bar("2", 0.25))->length, 0.5);
  EXPECT_EQ(Built(bar("1", 0.0) + bar("2", 40.0))->length, 40.0);
  EXPECT_EQ(Built(bar("1", 0.0) + bar("2", 4000.0))->length, 50.0);
}

TEST(Compile, ScalesRowsInMetresAndRatesOfLines) {
  const Built built("[scene]\nlength = 0.4\n" + four_bar());
  for (std::uint32_t i = 0; i < built->rows; ++i) {
    EXPECT_EQ(built->row_scale[i], built->equation_names[i].unit == "m" ? 1 / 0.4 : 1.0);
  }
  const Built slider(
      "[scene]\nlength = 0.4\n[[body]]\nname = 's'\n[[joint]]\nname = 's'\ntype = 'cylindrical'\n"
      "inlet = 'ground'\noutlet = 's'\n");
  EXPECT_EQ(slider->rate_scale, (std::vector<double>{1.0, 0.4}));
}

TEST(Compile, ToldWhenNothingGivesALength) {
  const Built built("[[body]]\nname = 'b'\n[[joint]]\nname = 'j'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'b'\n");
  EXPECT_EQ(built->length, 1.0);
  ASSERT_EQ(built.diagnostics.findings().size(), 1u);
  EXPECT_EQ(built.diagnostics.findings()[0].code, Code::no_length);
  EXPECT_EQ(built.diagnostics.findings()[0].severity, Severity::note);
}

TEST(Compile, CutsALoopAtAJointThatHasEquations) {
  const Built built(four_bar());
  ASSERT_EQ(built->loops, 1u);
  EXPECT_EQ(built->relations[0].kind, RelationKind::cut_joint);
  EXPECT_EQ(built->relations[0].rows, 5u);
  EXPECT_EQ(built->unknowns, 3u);
  EXPECT_EQ(built->relations[0].path.size(), 3u);
  EXPECT_NE(built->cut_at(built->relations[0].joint), nullptr);
}

TEST(Compile, PutsDrivenColumnsLast) {
  const Built built(four_bar(driven("c.angle")));
  EXPECT_EQ(built->unknowns, 2u);
  EXPECT_EQ(built->columns, 3u);
  EXPECT_EQ(built->rate_of_column.back(), built.joint("c").v);
  EXPECT_EQ(built->column_of_rate[built.joint("c").v], 2);
}

// No joint can be left out of the tree: each has a coordinate that somebody needs.
TEST(Compile, CutsABodyWhenAllJointsOfALoopAreDrivenOrCoupled) {
  const Built built(four_bar(driven("a.angle") + driven("b.angle") +
                             "[[constraint]]\nname = 'gear'\ntype = 'coupling'\ncoordinates = ['c.angle', 'd.angle']\n"
                             "factors = [1, 1]\noffset = 0\n"));
  ASSERT_EQ(built->loops, 1u);
  EXPECT_EQ(built->relations[0].kind, RelationKind::cut_body);
  EXPECT_EQ(built->relations[0].rows, 6u);
  EXPECT_EQ(built->nodes, 5u);
  EXPECT_EQ(built->rows, 7u);
  EXPECT_EQ(built->columns, 4u);
  EXPECT_EQ(built->relations[0].path.size(), 4u);
}

TEST(Compile, CutsElsewhereWhenTheCheapestJointIsDriven) {
  const Built built(four_bar(driven("d.angle")));
  EXPECT_EQ(built->relations[0].kind, RelationKind::cut_joint);
  EXPECT_NE(built->joints[built->relations[0].joint.index()].name, "d");
}

TEST(Compile, CutsABodyWhereNoJointHasEquations) {
  const Built built(replaced(four_bar(), "'revolute'", "'helical'\npitch = 0.1"));
  EXPECT_EQ(built->relations[0].kind, RelationKind::cut_body);
  EXPECT_EQ(built->mobility_count, -2);
}

struct Counted {
  const char* scene;
  std::int32_t mobility;
  std::uint32_t loops;
};

TEST(Compile, CountsMobilityAsGrueblerDoes) {
  for (const Counted& known : {Counted{"4bar", -2, 1}, Counted{"rstr", 1, 1}, Counted{"stewart", 6, 5},
                               Counted{"5link", 2, 5}, Counted{"bennett", -2, 1}, Counted{"7b10j", -8, 3},
                               Counted{"6r", 6, 0}, Counted{"arm2", 2, 0}, Counted{"multilink", 2, 5}}) {
    Registry registry(with_strangers());
    Diagnostics diagnostics;
    const auto scene = read_scene_file(
        registry, std::filesystem::path(scenes_folder()) / (std::string(known.scene) + ".toml"), diagnostics);
    ASSERT_TRUE(scene) << diagnostics.render();
    const auto mechanism = compile(*scene, diagnostics);
    ASSERT_TRUE(mechanism);
    EXPECT_EQ((*mechanism)->mobility_count, known.mobility) << known.scene;
    EXPECT_EQ((*mechanism)->loops, known.loops) << known.scene;
  }
}

TEST(Compile, NumbersStateBlocksInFileOrder) {
  const Built built(four_bar());
  for (std::size_t i = 0; i < built->joints.size(); ++i) {
    EXPECT_EQ(built->joints[i].q, i);
    EXPECT_EQ(built->coordinate_names[i].name, built->joints[i].name + ".angle");
  }
}

}  // namespace
}  // namespace koppel::test
