// Saved simulations go on bit for bit, and nothing else is taken for one.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace koppel::test {
namespace {

std::vector<unsigned char> saved(Simulation& simulation) {
  auto bytes = simulation.save();
  EXPECT_TRUE(bytes) << (bytes ? "" : koppel::render(bytes.error()));
  return bytes ? *bytes : std::vector<unsigned char>();
}

struct Way {
  const char* scene;
  IntegratorKind integrator;
  double duration;
};

/// In rows; saved and loaded at every third of them, and beside it saved only: libraries start again there.
TEST(Saving, GoesOnBitForBit) {
  const Way ways[] = {{"andrews", IntegratorKind::dormand_prince, 0.03},
                      {"andrews", IntegratorKind::cvode, 0.03},
                      {"andrews", IntegratorKind::arkode, 0.01},
                      {"bricard", IntegratorKind::dop853, 2.0},
                      {"bricard", IntegratorKind::classical, 1.0},
                      {"free_body", IntegratorKind::dormand_prince, 2.0},
                      {"fourbar_free", IntegratorKind::semi_implicit, 0.5},
                      {"fourbar_free", IntegratorKind::ida, 0.5},
                      {"free_body", IntegratorKind::generalised_alpha, 2.0},
                      {"bricard", IntegratorKind::generalised_alpha, 1.0}};
  for (const Way& way : ways) {
    SCOPED_TRACE(std::string(way.scene) + " by " +
                 std::string(integrators()[static_cast<std::size_t>(way.integrator)].name));
    const bool fixed = integrators()[static_cast<std::size_t>(way.integrator)].control == StepControl::step;
    const SimulationOptions how = by(way.integrator, fixed ? 0.0 : 1e-8, fixed ? 1e-3 : 0.0, way.duration);
    Simulated through(scene(way.scene), how), pieces(scene(way.scene), how);
    for (int i = 1; i <= 20; ++i) {
      const double time = way.duration * i / 20;
      through.to(time);
      pieces.to(time);
      ASSERT_EQ(through.state.q, pieces.state.q) << i;
      ASSERT_EQ(through.state.v, pieces.state.v) << i;
      ASSERT_EQ(through.state.a, pieces.state.a) << i;
      if (i % 3 != 0) continue;
      const std::vector<unsigned char> bytes = saved(*through.simulation);
      ASSERT_EQ(saved(*pieces.simulation), bytes);
      auto loaded = Simulation::load(pieces.built.mechanism, bytes);
      ASSERT_TRUE(loaded) << koppel::render(loaded.error());
      pieces.simulation = std::move(*loaded);
      EXPECT_EQ(pieces.simulation->shown(), time);
      pieces.to(time);
      ASSERT_EQ(through.state.q, pieces.state.q) << i;
    }
    EXPECT_EQ(through.simulation->summary().steps, pieces.simulation->summary().steps);
    EXPECT_EQ(through.simulation->summary().energy_error, pieces.simulation->summary().energy_error);
  }
}

TEST(Saving, RefusesWhatIsNoCheckpointOfTheScene) {
  Simulated run(scene("pendulum"), within(1e-8, 1.0));
  run.to(0.5);
  const std::vector<unsigned char> bytes = saved(*run.simulation);
  const auto message = [&](const std::vector<unsigned char>& given) {
    const auto loaded = Simulation::load(run.built.mechanism, given);
    EXPECT_FALSE(loaded);
    return loaded ? std::string() : loaded.error().message;
  };
  EXPECT_NE(message({}).find("not a saved simulation"), std::string::npos);
  std::vector<unsigned char> changed = bytes;
  changed[0] ^= 1;
  EXPECT_NE(message(changed).find("not a saved simulation"), std::string::npos);
  changed = bytes;
  changed[8] ^= 2;
  EXPECT_NE(message(changed).find("format"), std::string::npos);
  for (std::size_t at = 20; at < bytes.size(); at += 37) {
    changed = bytes;
    changed[at] ^= 1;
    EXPECT_NE(message(changed).find("damaged"), std::string::npos) << at;
  }
  for (std::size_t size = 20; size < bytes.size(); size += 41) {
    message(std::vector<unsigned char>(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
  }
  const Built other(scene("double_pendulum"));
  const auto loaded = Simulation::load(other.mechanism, bytes);
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().message.find("another scene"), std::string::npos);
}

}  // namespace
}  // namespace koppel::test
