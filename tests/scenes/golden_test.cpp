// Positions, rates and facts as the sources print them.
#include "golden.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "model.hpp"

namespace koppel::test {
namespace {

const Golden& golden() {
  static const Golden table = read_golden();
  return table;
}

constexpr double degree = std::numbers::pi / 180.0;

/// A case set up, closed and set in motion; gives every quantity that an expectation may name.
class Position {
 public:
  Position(const Model& model, const Case& described) : model_(model), case_(described), motion_(model) {}

  Outcome close() {
    Outcome outcome = case_.start ? close_once() : lead();
    if (!outcome) return outcome;
    for (const Setting& input : case_.inputs) {
      motion_.set_input(input_of(input), input.values.front(), speed_of(input.coordinate));
    }
    return motion_.rates();
  }

  koppel_analysis analysis() { return motion_.analysis(); }

  std::vector<double> quantity(const Expectation& wanted) {
    if (wanted.quantity == "value") return {value(motion_.positions(), KOPPEL_KIND_COORDINATE, wanted.name)};
    if (wanted.quantity == "rate") return {value(motion_.velocities(), KOPPEL_KIND_RATE, wanted.name)};
    if (wanted.quantity == "acceleration") return {value(motion_.accelerations(), KOPPEL_KIND_RATE, wanted.name)};
    if (wanted.quantity == "record") return {value(motion_.records(), KOPPEL_KIND_RECORD, wanted.name)};
    if (wanted.quantity == "sum") return {sum(wanted.name)};
    const std::size_t frame = frame_of(wanted.name);
    const Eigen::VectorXd pose = motion_.poses(kind_).col(static_cast<Eigen::Index>(frame));
    if (wanted.quantity == "rotation") return {pose.data(), pose.data() + 9};
    const Eigen::MatrixXd jacobian = motion_.jacobian(kind_, frame).value;
    if (wanted.quantity == "determinant") return {jacobian.determinant()};
    if (wanted.quantity == "rank") return {rank(jacobian)};
    return screw(wanted.quantity, pose, motion_.twists(kind_).col(static_cast<Eigen::Index>(frame)));
  }

 private:
  std::size_t input_of(const Setting& setting) const { return model_.find(KOPPEL_KIND_INPUT, setting.coordinate); }

  double speed_of(const std::string& coordinate) const {
    for (const Setting& speed : case_.speeds) {
      if (speed.coordinate == coordinate) return speed.values.front();
    }
    return 0.0;
  }

  Outcome close_once() {
    Eigen::VectorXd q = motion_.positions();
    for (const Setting& setting : *case_.start) {
      const std::string first = setting.coordinate + (setting.values.size() == 4 ? ".w" : "");
      auto at = static_cast<Eigen::Index>(model_.find(KOPPEL_KIND_COORDINATE, first));
      for (const double number : setting.values) q[at++] = number;
    }
    motion_.set_positions(q);
    for (const Setting& input : case_.inputs) motion_.set_input(input_of(input), input.values.front());
    return motion_.close();
  }

  /// From the scene's own start in a straight line to the inputs, in steps of at most 2 deg and 2 mm.
  Outcome lead() {
    Outcome outcome = motion_.close();
    const Eigen::VectorXd q = motion_.positions();
    std::vector<double> from;
    double steps = 1.0;
    for (const Setting& input : case_.inputs) {
      const std::size_t coordinate = model_.find(KOPPEL_KIND_COORDINATE, input.coordinate);
      from.push_back(q[static_cast<Eigen::Index>(coordinate)]);
      const double largest = model_.unit(KOPPEL_KIND_COORDINATE, coordinate) == "m" ? 0.002 : 2.0 * degree;
      steps = std::max(steps, std::ceil(std::abs(input.values.front() - from.back()) / largest));
    }
    for (double i = 1.0; i <= steps && outcome; ++i) {
      for (std::size_t k = 0; k < from.size(); ++k) {
        const double to = case_.inputs[k].values.front();
        motion_.set_input(input_of(case_.inputs[k]), i == steps ? to : from[k] + i / steps * (to - from[k]));
      }
      outcome = motion_.close();
    }
    return outcome;
  }

  double value(const Eigen::VectorXd& values, std::int32_t kind, const std::string& name) const {
    return values[static_cast<Eigen::Index>(model_.find(kind, name))];
  }

  /// "a.angle + b.angle - c.angle"
  double sum(const std::string& text) const {
    std::istringstream words(text);
    double result = 0.0, sign = 1.0;
    for (std::string word; words >> word;) {
      if (word == "+" || word == "-") {
        sign = word == "+" ? 1.0 : -1.0;
      } else {
        result += sign * value(motion_.positions(), KOPPEL_KIND_COORDINATE, word);
      }
    }
    return result;
  }

  /// The named frame or, without one of that name, the body.
  std::size_t frame_of(const std::string& name) {
    std::size_t index = 0;
    kind_ = KOPPEL_KIND_FRAME;
    if (koppel_mechanism_find(model_.get(), kind_, name.c_str(), &index, nullptr) >= 0) return index;
    kind_ = KOPPEL_KIND_BODY;
    return model_.find(kind_, name);
  }

  static double rank(const Eigen::MatrixXd& jacobian) {
    // The entries are of size 1 and known to rounding.
    return static_cast<double>((jacobian.jacobiSvd().singularValues().array() > 1e-12).count());
  }

  static std::vector<double> screw(const std::string& quantity, const Eigen::VectorXd& pose,
                                   const Eigen::VectorXd& twist) {
    const Eigen::Vector3d turn = twist.head<3>(), velocity = twist.tail<3>();
    if (quantity == "pitch") return {turn.dot(velocity) / turn.squaredNorm()};
    if (quantity != "axis_point") throw std::runtime_error("golden.toml: unknown quantity " + quantity);
    const Eigen::Vector3d point = position_of(pose) + turn.cross(velocity) / turn.squaredNorm();
    return {point.data(), point.data() + 3};
  }

  const Model& model_;
  const Case& case_;
  Motion motion_;
  std::int32_t kind_ = KOPPEL_KIND_FRAME;
};

class GoldenCase : public testing::TestWithParam<Case> {};

TEST_P(GoldenCase, IsMet) {
  const Model model(golden().text(GetParam().scene));
  Position position(model, GetParam());
  const Outcome outcome = position.close();
  if (!GetParam().closes) {
    EXPECT_EQ(outcome.status, KOPPEL_NOT_CLOSED);
    return;
  }
  ASSERT_TRUE(outcome) << outcome.message;
  EXPECT_EQ(position.analysis().mobility_rank, golden().facts(GetParam().scene).mobility);
  for (const Expectation& expected : GetParam().expect) {
    const std::vector<double> values = position.quantity(expected);
    ASSERT_EQ(values.size(), expected.values.size());
    const double tolerance = 0.5 * std::pow(10.0, -expected.digits);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool degrees = expected.unit == "deg";
      const double difference = values[i] / (degrees ? degree : 1.0) - expected.values[i];
      EXPECT_LE(std::abs(degrees ? std::remainder(difference, 360.0) : difference), tolerance)
          << expected.quantity << " of " << expected.name << ", component " << i << ", source " << GetParam().source;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenCase, testing::ValuesIn(golden().cases),
                         [](const auto& test) { return test.param.name; });

struct GoldenFacts : testing::TestWithParam<Facts> {
  const Model model{golden().text(GetParam().scene)};
};

TEST_P(GoldenFacts, CountsAgree) {
  EXPECT_EQ(model.sizes().bodies - 1, GetParam().bodies);
  EXPECT_EQ(model.sizes().joints, GetParam().joints);
  EXPECT_EQ(model.sizes().loops, GetParam().loops);
  EXPECT_EQ(model.sizes().rates, GetParam().freedoms);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenFacts, testing::ValuesIn(golden().scenes),
                         [](const auto& test) { return test_name(test.param.scene); });

std::vector<Facts> closing_scenes() {
  std::vector<Facts> closing;
  for (const Facts& facts : golden().scenes) {
    if (facts.closes) closing.push_back(facts);
  }
  return closing;
}

using GoldenRun = GoldenFacts;

// A joint that closes a loop has its freedoms in the whole Jacobian, and as many more rows that they fill.
TEST_P(GoldenRun, ClosesWithTheSameRankAndMobilityAtEveryStep) {
  Motion motion(model);
  for (std::size_t i = 0; i <= model.settings().steps; ++i) {
    ASSERT_TRUE(motion.move(model.time(i))) << "step " << i;
    const koppel_analysis analysis = motion.analysis();
    EXPECT_EQ(analysis.mobility_count, GetParam().count);
    EXPECT_EQ(analysis.mobility_rank, GetParam().mobility) << "step " << i;
    EXPECT_EQ(analysis.rank + model.sizes().rates - analysis.tree_rates, GetParam().rank) << "step " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenRun, testing::ValuesIn(closing_scenes()),
                         [](const auto& test) { return test_name(test.param.scene); });

TEST(GoldenTable, KnowsEveryShippedScene) {
  for (const std::string& scene : shipped_scenes()) EXPECT_NO_THROW(golden().facts(scene));
}

}  // namespace
}  // namespace koppel::test
