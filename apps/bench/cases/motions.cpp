// Motions by forces that are hard to integrate.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "bench/cases.hpp"
#include "bench/chains.hpp"
#include "bench/trial.hpp"

namespace koppel::app::bench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tolerance = 1e-10;

/// Each step may be off by the tolerance; an error of a rate grows with the time that is left, and that of an angle as
/// fast as neighbouring motions part: `growth` in all.
Outcome moved_to(Model model, const Problem& problem, double growth) {
  Trial trial(std::move(model), problem.end);
  if (!trial.problem().empty()) return {trial.problem(), infinity, tolerance};
  const Reference reference = reference_of(problem, trial);
  if (std::isnan(trial.run({dormand_prince, tolerance}))) return {trial.problem(), infinity, tolerance};
  const auto steps = static_cast<double>(trial.summary().steps);
  std::ostringstream found;
  found << trial.summary().steps << " steps; energy to " << std::setprecision(2)
        << trial.summary().energy_error / trial.summary().energy_size << ", loops to "
        << trial.summary().position_drift;
  return {found.str(), error_of(trial, reference), tolerance * steps * growth + reference.uncertainty};
}

/// Of the table of problems.
Outcome known(const Plan& plan, const std::string& name, double growth) {
  const auto found =
      std::find_if(problems().begin(), problems().end(), [&](const Problem& p) { return p.name == name; });
  return moved_to(load(plan.scenes + "/dynamics/" + name + ".toml", false), *found, growth);
}

/// A bob on a massless bar, let go level at a place of the world, and another one of 1e-12 kg on it.
std::string pendulum(double place, bool tip) {
  std::ostringstream text;
  text << std::setprecision(17) << "schema = 1\n[scene]\nname = 'pendulum'\ngravity = [0, -9.81, 0]\nlength = 1\n"
       << "[[body]]\nname = 'bob'\ntype = 'point_mass'\nmass = 1\nat = [0, -1, 0]\n"
       << "[[joint]]\nname = 'pivot'\ntype = 'revolute'\ninlet = { on = 'ground', at = [" << place << ", "
       << 0.7 * place << ", " << -0.3 * place << "] }\noutlet = 'bob'\nstart = { angle = '-90 deg' }\n";
  if (tip) {
    text << "[[body]]\nname = 'tip'\ntype = 'point_mass'\nmass = 1e-12\nat = [0, -1, 0]\n"
         << "[[joint]]\nname = 'second'\ntype = 'revolute'\ninlet = { on = 'bob', at = [0, -1, 0] }\noutlet = 'tip'\n";
  }
  return text.str();
}

/// IFToMM A01 after 1 s: asin of its x.
Problem a01_after_a_second() {
  return {"", 1.0, {{"pivot.angle", std::asin(0.986291751131875319)}}, "IFToMM A01 in quadruple precision"};
}

Outcome light_tip(const Plan&) {
  // What the tip does to the bob is of the order of its mass, 1e-12.
  return moved_to(load_text(pendulum(0.0, true)), a01_after_a_second(), 10.0);
}

Outcome far_pendulum(const Plan&) {
  Problem problem = a01_after_a_second();
  problem.uncertainty = 10.0 * 1e6 * std::numeric_limits<double>::epsilon();  // places are rounded
  return moved_to(load_text(pendulum(1e6, false)), problem, 10.0);
}

/// A parallelogram of bars of 1e-6 and 1e6 kg and a coupler of 1 kg, let go at 60 deg from hanging.
Outcome masses(const Plan&) {
  std::ostringstream text;
  text << "schema = 1\n[scene]\nname = 'parallelogram'\ngravity = [0, -9.81, 0]\nlength = 1\n";
  const auto bar = [&](const char* name, const char* mass, const char* along, const char* rest) {
    text << "[[body]]\nname = '" << name << "'\nmass = " << mass << "\n"
         << along << "[[joint]]\nname = '" << name << "'\ntype = 'revolute'\noutlet = '" << name << "'\n"
         << rest;
  };
  bar("light", "1e-6", "centre_of_mass = [0, -0.5, 0]\ninertia = ['1e-6/12', 0, '1e-6/12', 0, 0, 0]\n",
      "inlet = 'ground'\nstart = { angle = '60 deg' }\n");
  bar("heavy", "1e6", "centre_of_mass = [0, -0.5, 0]\ninertia = ['1e6/12', 0, '1e6/12', 0, 0, 0]\n",
      "inlet = { on = 'ground', at = [1.5, 0, 0] }\nstart = { angle = '60 deg' }\n");
  bar("coupler", "1", "centre_of_mass = [0.75, 0, 0]\ninertia = [0, '2.25/12', '2.25/12', 0, 0, 0]\n",
      "inlet = { on = 'light', at = [0, -1, 0] }\nstart = { angle = '-60 deg' }\n");
  text << "[[joint]]\nname = 'end'\ntype = 'revolute'\ninlet = { on = 'heavy', at = [0, -1, 0] }\n"
       << "outlet = { on = 'coupler', at = [1.5, 0, 0] }\nstart = { angle = '-60 deg' }\n";
  const double sum = 1e6 + 1e-6;
  const double k = 9.81 * (sum / 2 + 1) / (sum / 3 + 1);
  const Problem problem{
      "", 1.0, {{"light.angle", swing(k, 1.0471975511965977462, 0.0, 1.0)}}, "moves like one pendulum", 1e-15};
  return moved_to(load_text(text.str()), problem, 10.0);
}

Outcome ten_rods(const Plan&) {
  const Problem problem{"",
                        0.2,
                        {{"tip.x", 0.93543487658034883381}, {"tip.y", -0.19618382492755433533}},
                        "reduced equations in quadruple precision"};
  return moved_to(load_text(pendulum_chain(10)), problem, 100.0);
}

/// A ball that spins by itself at 1 rad/s, in steps of 1e-2 s.
Outcome spinning_ball(const Plan& plan) {
  const double steps = plan.quick ? 1e6 : 1e8, end = 1e-2 * steps;
  const char* const ball =
      "schema = 1\n[scene]\nname = 'ball'\nlength = 1\n"
      "[[body]]\nname = 'ball'\nmass = 1\ninertia = [1, 1, 1, 0, 0, 0]\n"
      "[[joint]]\nname = 'pivot'\ntype = 'spherical'\noutlet = 'ball'\ninlet = 'ground'\n"
      "start_rate = { rotation = [0.36, 0.48, 0.8] }\n";
  Trial trial(load_text(ball), end);
  // Each step rounds the quaternion.
  const double allowed = steps * std::numeric_limits<double>::epsilon();
  if (std::isnan(trial.run({semi_implicit, 1e-2}))) return {trial.problem(), infinity, allowed};
  const std::vector<double> q =
      trial.values({"pivot.rotation.w", "pivot.rotation.x", "pivot.rotation.y", "pivot.rotation.z"});
  const double cosine = std::cos(end / 2), sine = std::sin(end / 2);
  const double expected[] = {cosine, 0.36 * sine, 0.48 * sine, 0.8 * sine};
  double size = 0.0, to = 0.0, to_opposite = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    size += q[i] * q[i];
    to = std::max(to, std::abs(q[i] - expected[i]));
    to_opposite = std::max(to_opposite, std::abs(q[i] + expected[i]));
  }
  std::ostringstream found;
  found << std::setprecision(2) << trial.summary().steps << " steps; length of the quaternion off by "
        << std::abs(std::sqrt(size) - 1.0);
  return {found.str(), std::min(to, to_opposite), allowed};
}

// Growth: linear in time for motions of one freedom, (1 + end * rate).
Outcome flat_bars(const Plan& plan) { return known(plan, "nfourbar", 100.0); }
Outcome folding_motion(const Plan& plan) { return known(plan, "folding_slidercrank", 100.0); }
Outcome bricard(const Plan& plan) { return known(plan, "bricard", 100.0); }
Outcome governor(const Plan& plan) { return known(plan, "governor", 10.0); }
Outcome fast_top(const Plan& plan) { return known(plan, "heavy_top", 300.0); }

}  // namespace

std::vector<Case> hard_motions() {
  return {
      {"flat_bars", "IFToMM A02, 10 s: whenever the bars lie flat, one freedom becomes three",
       "the bars' angle of the reduced equation, to the tolerance of 1e-10 times steps and time", flat_bars},
      {"folding_motion", "a slider-crank of equal lengths that swings past upright, where it could fold, for 10 s",
       "the crank of the reduced equation, to the tolerance times steps and time", folding_motion},
      {"bricard", "IFToMM A04, 10 s: two equations too many at every position",
       "the closed form's angles, to the tolerance times steps and time", bricard},
      {"stiff_governor", "IFToMM A05, 0.1 s: springs that die out in milliseconds",
       "slider and shaft in quadruple precision, to the tolerance times steps", governor},
      {"fast_top", "a top of 150 rad/s for 2 s",
       "its rotation in extended precision, to the tolerance times steps and turn", fast_top},
      {"ten_rods", "ten rods that hang on each other",
       "the tip in quadruple precision after 0.2 s, to the tolerance times steps", ten_rods},
      {"light_tip", "a double pendulum whose second bob weighs 1e-12 of the first",
       "the first one moves as if alone, to the tolerance times steps", light_tip},
      {"masses", "a parallelogram of masses over twelve decades",
       "moves like one pendulum, to the tolerance times steps", masses},
      {"spinning_ball", "a quaternion that turns for 10^8 steps (10^6 with --quick)",
       "the turn that the time makes, to rounding times steps", spinning_ball},
      {"far_pendulum", "a pendulum a million metres from the origin",
       "swings as at the origin, to the tolerance times steps and the rounding of places", far_pendulum},
  };
}

}  // namespace koppel::app::bench
