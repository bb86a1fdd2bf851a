// A four-bar with two point masses and a spring as a scene, and the same in closed form by Taylor polynomials.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace koppel::test {

/// Value, first and second derivative along the crank's angle.
struct Jet {
  double value = 0.0, first = 0.0, second = 0.0;

  Jet(double v = 0.0, double f = 0.0, double s = 0.0) : value(v), first(f), second(s) {}
  friend Jet operator+(const Jet& a, const Jet& b) {
    return {a.value + b.value, a.first + b.first, a.second + b.second};
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return {a.value - b.value, a.first - b.first, a.second - b.second};
  }
  friend Jet operator*(const Jet& a, const Jet& b) {
    return {a.value * b.value, a.first * b.value + a.value * b.first,
            a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const double value = a.value / b.value, first = (a.first - value * b.first) / b.value;
    return {value, first, (a.second - 2.0 * first * b.first - value * b.second) / b.value};
  }
};

inline Jet sqrt(const Jet& a) {
  const double root = std::sqrt(a.value), first = a.first / (2.0 * root);
  return {root, first, (a.second / 2.0 - first * first) / root};
}

struct JetPoint {
  Jet x, y;
};

/// Crank 0.1 m, coupler 0.335 m, rocker 0.255 m, pivots 0.35 m apart along x; y up. Masses sit at the coupler's ends,
/// the spring pulls the crank's end to a point of the ground.
struct FourBar {
  static constexpr double crank = 0.1, coupler = 0.335, rocker = 0.255, ground = 0.35, g = 9.81;
  static constexpr double mass_a = 2.0, mass_b = 3.0, stiffness = 400.0, length = 0.2;
  static constexpr double anchor_x = 0.2, anchor_y = 0.3;

  JetPoint a, b;

  explicit FourBar(double angle) {
    const Jet c(std::cos(angle), -std::sin(angle), -std::cos(angle));
    const Jet s(std::sin(angle), std::cos(angle), -std::sin(angle));
    a = {crank * c, crank * s};
    // The upper of the two points at the coupler's and the rocker's distance from their ends.
    const Jet dx = ground - a.x, dy = Jet() - a.y;
    const Jet square = dx * dx + dy * dy;
    const Jet along = (coupler * coupler - rocker * rocker + square) / (2.0 * square);
    const Jet up = sqrt(coupler * coupler / square - along * along);
    b = {a.x + along * dx - up * dy, a.y + along * dy + up * dx};
  }

  Jet potential() const {
    const Jet dx = a.x - anchor_x, dy = a.y - anchor_y;
    const Jet stretch = sqrt(dx * dx + dy * dy) - length;
    return mass_a * g * a.y + mass_b * g * b.y + 0.5 * stiffness * stretch * stretch;
  }
  /// Mass in the crank's angle.
  double mass() const { return mass_a * crank * crank + mass_b * (b.x.first * b.x.first + b.y.first * b.y.first); }
  /// Rate of the rocker's angle by that of the crank's.
  double rocker_rate() const { return ((b.x.value - ground) * b.y.first - b.y.value * b.x.first) / (rocker * rocker); }

  /// order: of the four joints in the file, by which the loop is cut elsewhere.
  static std::string scene(const std::vector<std::string>& order = {"crank", "a", "b", "rocker"},
                           const std::string& more = "") {
    std::string text =
        "[scene]\ngravity = [0, -9.81, 0]\n[[body]]\nname = 'crank'\n[[body]]\nname = 'coupler'\n"
        "[[body]]\nname = 'rocker'\n"
        "[[body]]\nname = 'at_a'\ntype = 'point_mass'\nmass = 2\n[[body]]\nname = 'at_b'\ntype = 'point_mass'\nmass = "
        "3\n";
    for (const std::string& name : order) {
      text += "[[joint]]\nname = '" + name + "'\ntype = 'revolute'\n";
      if (name == "crank") text += "inlet = 'ground'\noutlet = 'crank'\nstart = { angle = 1.0 }\n";
      if (name == "a") text += "inlet = { on = 'crank', at = [0.1, 0, 0] }\noutlet = 'coupler'\n";
      if (name == "b")
        text += "inlet = { on = 'coupler', at = [0.335, 0, 0] }\noutlet = { on = 'rocker', at = [0.255, 0, 0] }\n";
      if (name == "rocker")
        text += "inlet = { on = 'ground', at = [0.35, 0, 0] }\noutlet = 'rocker'\nstart = { angle = 1.5 }\n";
    }
    text +=
        "[[joint]]\nname = 'on_a'\ntype = 'weld'\ninlet = { on = 'crank', at = [0.1, 0, 0] }\noutlet = 'at_a'\n"
        "[[joint]]\nname = 'on_b'\ntype = 'weld'\ninlet = { on = 'rocker', at = [0.255, 0, 0] }\noutlet = 'at_b'\n"
        "[[force]]\nname = 'spring'\ntype = 'spring'\nfrom = { on = 'ground', at = [0.2, 0.3, 0] }\n"
        "to = { on = 'crank', at = [0.1, 0, 0] }\nstiffness = 400\nlength = 0.2\n";
    return text + more;
  }
};

}  // namespace koppel::test
