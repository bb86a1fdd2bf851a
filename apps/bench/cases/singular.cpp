// Positions where branches meet, and where a drive goes no further.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/cases.hpp"
#include "bench/cases/moved.hpp"

namespace koppel::app::bench {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Beside a change point positions follow from the branch to this much (README.md, "Dead centres and change points").
constexpr double beside_change_points = 1e-9;

std::string passed(const Moved& moved) { return "passed " + std::to_string(moved.change_points()) + " change points"; }

std::string stopped(const Moved& moved) { return "stopped: " + moved.message(); }

/// Moves the crank from one angle to another in 97 steps and compares the rocker with what it should be.
template <typename Expected>
Outcome swept(const FourBar& bar, double from, double to, int side, int branch, const Expected& expected) {
  Moved moved(bar.scene(from, to - from, side));
  double worst = 0.0;
  for (int i = 0; i <= 97; ++i) {
    const double time = i / 97.0;
    if (!moved.to(time, branch)) return {stopped(moved), infinity, beside_change_points};
    worst = std::max(worst, apart(moved.q("rocker.angle"), expected(from + (to - from) * time)));
  }
  return {passed(moved), worst, beside_change_points};
}

Outcome parallelogram_stays(const Plan&) {
  return swept({2, 1, 2, 1}, 0.3, 0.3 + 2 * pi, 1, KOPPEL_BRANCH_STAY, [](double crank) { return crank; });
}

Outcome parallelogram_folds(const Plan&) {
  // Of the two branches phi = theta and tan(phi/2) = -(g+a)/(g-a) tan(theta/2), the second from 180 deg on.
  return swept({2, 1, 2, 1}, 0.5, 5.5, 1, KOPPEL_BRANCH_TAKE,
               [](double crank) { return crank < pi ? crank : 2.0 * std::atan(-3.0 * std::tan(crank / 2)); });
}

Outcome kite(const Plan&) {
  // At 0 the crank's end lies on the rocker's pivot, and the rocker could turn by itself.
  return swept({1, 1, 2, 2}, -1.0, 1.1, -1, KOPPEL_BRANCH_STAY,
               [](double crank) { return crank / 2 + std::asin(std::sin(crank / 2) / 2); });
}

/// A slider-crank whose crank and rod are equally long.
std::string equal_slider_crank() {
  return "schema = 1\n[scene]\nname = 'slider_crank'\n[[body]]\nname = 'crank'\n[[body]]\nname = 'rod'\n"
         "[[body]]\nname = 'slider'\n[[joint]]\nname = 'crank'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'crank'\n"
         "[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = { on = 'crank', at = [1, 0, 0] }\noutlet = 'rod'\n"
         "start = { angle = -1 }\n[[joint]]\nname = 'wrist'\ntype = 'revolute'\ninlet = { on = 'rod', at = [1, 0, 0] "
         "}\n"
         "outlet = 'slider'\nstart = { angle = 0.5 }\n[[joint]]\nname = 'slider'\ntype = 'prismatic'\n"
         "inlet = { on = 'ground', rotate = [['y', '90 deg']] }\noutlet = { on = 'slider', rotate = [['y', '90 deg']] "
         "}\n"
         "start = { displacement = 1.755 }\n"
         "[[drive]]\nof = 'crank.angle'\ntype = 'ramp'\nstart = 0.5\nslope = 2\n";
}

Outcome folding(const Plan&) {
  Moved moved(equal_slider_crank());
  double worst = 0.0;
  for (int i = 0; i <= 97; ++i) {
    const double time = i / 97.0;
    if (!moved.to(time)) return {stopped(moved), infinity, beside_change_points};
    worst = std::max(worst, std::abs(moved.q("slider.displacement") - 2.0 * std::cos(0.5 + 2.0 * time)));
  }
  return {passed(moved), worst, beside_change_points};
}

/// A crank-rocker whose rocker is driven, towards the dead centre at which coupler and crank lie in line, folded: a
/// FourBar of which crank and rocker changed places.
constexpr FourBar rocker_driven{0.35, 0.255, 0.335, 0.1};

/// The angle of the driven link at the dead centre, by the law of cosines.
double dead_centre() {
  const FourBar& bar = rocker_driven;
  const double reach = bar.coupler - bar.rocker;
  return std::acos((bar.ground * bar.ground + bar.crank * bar.crank - reach * reach) / (2 * bar.ground * bar.crank));
}

constexpr double located = 1e-9;  // how near koppel.h promises to locate a limit

Outcome limit_is_found(const Plan&) {
  Moved moved(rocker_driven.scene(dead_centre() + 0.5, -2.0, 1));
  for (int i = 0; i <= 50; ++i) {
    if (moved.to(i / 50.0)) continue;
    if (moved.report().verdict != KOPPEL_VERDICT_LIMIT) return {stopped(moved), infinity, located};
    return {"stopped at the limit", std::abs(moved.report().limit_value - dead_centre()), located};
  }
  return {"went through a limit", infinity, located};
}

Outcome limit_is_passed(const Plan&) {
  Moved moved(rocker_driven.scene(dead_centre() + 0.1, -1.0, 1));
  if (!moved.to(0.0)) return {stopped(moved), infinity, located};
  double least = infinity, worst = 0.0;
  unsigned limits = 0;
  for (int i = 0; i < 50; ++i) {
    if (!moved.along(0.01)) return {stopped(moved), infinity, located};
    limits += moved.report().limits;
    const double driven = moved.q("crank.angle"), other = moved.q("rocker.angle");
    least = std::min(least, driven);
    // Closed on the one side or on the other: beside the limit both are near, and one of them must be met.
    worst = std::max(worst, std::min(apart(other, rocker_driven.rocker_angle(driven, -1)),
                                     apart(other, rocker_driven.rocker_angle(driven, 1))));
  }
  if (limits != 1) return {std::string("passed ") + std::to_string(limits) + " limits", infinity, located};
  return {"passed one limit, the drive turning back", std::max(dead_centre() - least, worst), located};
}

}  // namespace

std::vector<Case> singular_positions() {
  return {
      {"parallelogram", "a parallelogram lies in line twice a turn, where it could fold over",
       "goes round as a parallelogram; the rocker stands like the crank, to 1e-9", parallelogram_stays},
      {"parallelogram_folds", "the same, told to take the other branch",
       "from 180 deg on tan(rocker/2) = -3 tan(crank/2), to 1e-9", parallelogram_folds},
      {"kite", "two pivots fall together, and one link could spin by itself",
       "rocker = crank/2 + asin(sin(crank/2)/2) all along, to 1e-9", kite},
      {"folding_crank", "crank and rod of equal lengths stand upright, where they could stay folded",
       "slider at 2 cos(crank) all along, to 1e-9", folding},
      {"dead_centre", "the driven link goes to where the others are in line",
       "stops there and says where, to 1e-9; by the law of cosines", limit_is_found},
      {"past_dead_centre", "the same, told to go on along the curve of closed positions",
       "one limit is passed, the loop stays closed, the drive turns back at the limit, to 1e-9", limit_is_passed},
  };
}

}  // namespace koppel::app::bench
