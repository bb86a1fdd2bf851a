// Mechanisms of odd measures: nearly parallel axes, extreme ratios, far away, tiny and huge.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

#include "bench/cases.hpp"
#include "bench/cases/moved.hpp"

namespace koppel::app::bench {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// What coordinates of a well conditioned position are good to (koppel calls no residual above 1e-13 exact).
constexpr double exact = 1e-12;

std::string in_words(const char* what, int done, int all) {
  return std::to_string(done) + " of " + std::to_string(all) + ' ' + what;
}

/// Two shafts at an angle of 10^-1 to 10^-12 rad, joined by a Cardan joint: tan(out) = tan(in) cos(angle).
std::string cardan(double angle) {
  std::ostringstream text;
  text << std::setprecision(17)
       << "schema = 1\n[scene]\nname = 'cardan'\nlength = 1\n[[body]]\nname = 'in'\n[[body]]\nname = 'out'\n"
       << "[[joint]]\nname = 'in'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'in'\n"
       << "[[joint]]\nname = 'cross'\ntype = 'universal'\ninlet = { on = 'in', axis = [1, 0, 0], x_axis = [0, 1, 0] }\n"
       << "outlet = { on = 'out', axis = [1, 0, 0], x_axis = [0, 1, 0] }\n"
       << "[[joint]]\nname = 'out'\ntype = 'revolute'\ninlet = { on = 'ground', rotate = [['x', " << angle
       << "]] }\noutlet = 'out'\n[[drive]]\nof = 'in.angle'\ntype = 'ramp'\nslope = 3\n";
  return text.str();
}

Outcome nearly_parallel_shafts(const Plan&) {
  double worst = 0.0;
  int done = 0;
  for (int k = 1; k <= 12; ++k) {
    const double angle = std::pow(10.0, -k);
    Moved moved(cardan(angle));
    bool fine = true;
    double off = 0.0;
    for (int i = 0; i <= 30 && fine; ++i) {
      const double time = i / 30.0, in = 3.0 * time;
      fine = moved.to(time);
      off = std::max(off, apart(moved.q("out.angle"), std::atan2(std::sin(in) * std::cos(angle), std::cos(in))));
    }
    if (!fine) return {std::string("stopped at 1e-") + std::to_string(k) + ": " + moved.message(), infinity, exact};
    worst = std::max(worst, off);
    ++done;
  }
  return {in_words("angles between the shafts", done, 12), worst, exact};
}

/// Bennett's linkage of links 1 and 2 m with twists asin(t) and asin(2 t): tan(in/2) tan(out/2) = const.
struct Bennett {
  explicit Bennett(double t) : alpha(std::asin(t)), beta(std::asin(2 * t)) {
    // K = sin((beta+alpha)/2) / sin((beta-alpha)/2)
    ratio = std::sin((beta + alpha) / 2) / std::sin((beta - alpha) / 2);
  }
  double alpha, beta, ratio;

  /// Of the joint at the other end of the first link, from the one at its beginning; 0: links along each other.
  double next(double angle) const { return 2.0 * std::atan(ratio / std::tan(angle / 2)); }

  std::string scene(double start) const {
    // Each link from its joint's axis along x, then twisted about x to the next joint's axis.
    const double other = next(start);
    std::ostringstream text;
    text << std::setprecision(17) << "schema = 1\n[scene]\nname = 'bennett'\nlength = 1\n";
    for (const char* name : {"a", "b", "c"}) text << "[[body]]\nname = '" << name << "'\n";
    const auto joint = [&](const char* name, const char* from, double length, double twist, const char* to,
                           double angle) {
      text << "[[joint]]\nname = '" << name << "'\ntype = 'revolute'\ninlet = { on = '" << from << "', at = [" << length
           << ", 0, 0], rotate = [['x', " << twist << "]] }\noutlet = '" << to << "'\nstart = { angle = " << angle
           << " }\n";
    };
    joint("p", "ground", 0, 0, "a", start);
    joint("q", "a", 1, alpha, "b", other);
    joint("r", "b", 2, beta, "c", -start);
    // From c, of length 1 and twist alpha, back to the ground, of length 2 and twist beta, which ends at p.
    text << "[[joint]]\nname = 's'\ntype = 'revolute'\ninlet = { on = 'c', at = [1, 0, 0], rotate = [['x', " << alpha
         << "]] }\noutlet = { on = 'ground', rotate = [['x', " << -beta
         << "]], at = [-2, 0, 0] }\nstart = { angle = " << -other
         << " }\n[[drive]]\nof = 'p.angle'\ntype = 'ramp'\nstart = " << start << "\nslope = 1\n";
    return text.str();
  }
};

Outcome nearly_parallel_bennett(const Plan&) {
  double worst = 0.0;
  int done = 0;
  for (int k = 1; k <= 12; ++k) {
    const Bennett linkage(0.4 * std::pow(10.0, 1 - k));
    constexpr double start = 1.0;
    Moved moved(linkage.scene(start));
    for (int i = 0; i <= 30; ++i) {
      const double time = i / 30.0;
      if (!moved.to(time))
        return {std::string("stopped at twist 4e-") + std::to_string(k) + ": " + moved.message(), infinity, exact};
      worst = std::max(worst, apart(moved.q("q.angle"), linkage.next(start + time)));
    }
    ++done;
  }
  return {in_words("twists", done, 12), worst, exact};
}

/// The worst of a turn of the crank, of four-bars and what their rocker may be off.
struct Sized {
  FourBar bar;
  double allowed;
};

Outcome turned(const std::vector<Sized>& bars, const char* what) {
  double worst = 0.0, allowed = bars.front().allowed;
  int done = 0;
  for (const Sized& sized_bar : bars) {
    const FourBar& bar = sized_bar.bar;
    Moved moved(bar.scene(0.3, 2 * pi, 1));
    double off = 0.0;
    for (int i = 0; i <= 60; ++i) {
      if (!moved.to(i / 60.0))
        return {std::string("stopped after ") + in_words(what, done, static_cast<int>(bars.size())) + ": " +
                    moved.message(),
                infinity, allowed};
      off = std::max(off, apart(moved.q("rocker.angle"), bar.rocker_angle(0.3 + 2 * pi * i / 60.0, 1)));
    }
    if (off / sized_bar.allowed > worst / allowed) {
      worst = off;
      allowed = sized_bar.allowed;
    }
    ++done;
  }
  return {in_words(what, done, static_cast<int>(bars.size())), worst, allowed};
}

constexpr FourBar crank_rocker{0.35, 0.1, 0.335, 0.255};

Outcome link_ratios(const Plan&) {
  std::vector<Sized> bars;
  for (int k = 1; k <= 8; ++k) {
    const double ratio = std::pow(10.0, -k);
    bars.push_back({{1.0, ratio, 0.8, 0.7}, exact});
    // All moving links small beside the ground and the coupler, which differ by a little: angles suffer as the ratio
    // is.
  }
  return turned(bars, "ratios");
}

Outcome huge_coupler(const Plan&) {
  std::vector<Sized> bars;
  for (int k = 1; k <= 8; ++k) {
    const double ratio = std::pow(10.0, k);
    // The rocker's angle follows from differences of the two long links: rounding of them, over the rocker's length.
    bars.push_back({{ratio, 1.0, ratio, 2.0}, exact + 8.0 * eps * ratio});
  }
  return turned(bars, "ratios");
}

Outcome far_away(const Plan&) {
  std::vector<Sized> bars;
  for (const double distance : {1e3, 1e6}) {
    FourBar bar = crank_rocker;
    bar.x = distance;
    bar.y = 0.7 * distance;
    bar.height = -0.3 * distance;
    // Places are rounded to half a unit in the last digit of the distance; over the shortest link, the sine of the
    // least transmission angle (above 0.3) and for the two pivots.
    bars.push_back({bar, exact + 2.0 * distance * eps / (crank_rocker.crank * 0.3)});
  }
  return turned(bars, "distances");
}

Outcome sizes(const Plan&) {
  std::vector<Sized> bars;
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    FourBar bar = crank_rocker;
    bar.scale = scale;
    bars.push_back({bar, exact});
  }
  return turned(bars, "scales");
}

}  // namespace

std::vector<Case> odd_measures() {
  return {
      {"nearly_parallel_shafts", "two shafts at 1e-1 to 1e-12 rad, joined by a Cardan joint",
       "tan(out) = tan(in) cos(angle), to 1e-12", nearly_parallel_shafts},
      {"nearly_parallel_bennett", "Bennett's linkage, three equations too many, its twists going down to 4e-13 rad",
       "tan(in/2) tan(out/2) constant, to 1e-12", nearly_parallel_bennett},
      {"short_crank", "a crank of 1e-1 to 1e-8 of the other links", "the rocker by the law of cosines, to 1e-12",
       link_ratios},
      {"long_coupler", "ground and coupler of 1e1 to 1e8 times the other links",
       "the rocker by the law of cosines, to 1e-12 and the rounding of the long links", huge_coupler},
      {"far_away", "a four-bar a thousand and a million metres from the origin",
       "the rocker as at the origin, to 1e-12 and the rounding of the places", far_away},
      {"sizes", "a four-bar in micrometres, millimetres, kilometres and megametres", "the rocker at any size, to 1e-12",
       sizes},
  };
}

}  // namespace koppel::app::bench
