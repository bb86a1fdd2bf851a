#include "bench/chains.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace koppel::app::bench {
namespace {

std::ostringstream writer(const char* scene) {
  std::ostringstream text;
  text << std::setprecision(17) << "schema = 1\n[scene]\n" << scene << "\n";
  return text;
}

void body(std::ostream& out, const std::string& name, const std::string& rest = "") {
  out << "[[body]]\nname = '" << name << "'\n" << rest;
}

/// inlet and outlet as they stand in the scene.
void revolute(std::ostream& out, const std::string& name, const std::string& inlet, const std::string& outlet,
              const std::string& rest = "") {
  out << "[[joint]]\nname = '" << name << "'\ntype = 'revolute'\ninlet = " << inlet << "\noutlet = " << outlet << "\n"
      << rest;
}

std::string on(const std::string& body, double x, double y = 0.0) {
  std::ostringstream text;
  text << std::setprecision(17) << "{ on = '" << body << "', at = [" << x << ", " << y << ", 0] }";
  return text.str();
}

std::string numbered(const char* name, int i) { return name + std::to_string(i); }

}  // namespace

std::string pendulum_chain(int count) {
  std::ostringstream text = writer("name = 'pendulum_chain'\ngravity = [0, -9.81, 0]\nlength = 1");
  const double length = 1.0 / count;
  std::ostringstream inertia;
  inertia << std::setprecision(17) << "mass = " << length << "\ncentre_of_mass = [" << length / 2
          << ", 0, 0]\ninertia = [0, " << length * length * length / 12 << ", " << length * length * length / 12
          << ", 0, 0, 0]\n";
  for (int i = 0; i < count; ++i) {
    body(text, numbered("rod", i), inertia.str());
    const std::string inlet = i == 0 ? "'ground'" : on(numbered("rod", i - 1), length);
    revolute(text, numbered("joint", i), inlet, '\'' + numbered("rod", i) + '\'');
  }
  text << "[[frame]]\nname = 'tip'\non = '" << numbered("rod", count - 1) << "'\nat = [" << length
       << ", 0, 0]\n[[record]]\nof = 'tip'\n";
  return text.str();
}

std::string fourbar_chain(int count) {
  std::ostringstream text = writer("name = 'fourbar_chain'\ngravity = [0, -9.81, 0]\nlength = 1");
  for (int i = 0; i <= count; ++i) {
    body(text, numbered("bar", i), "mass = 1\ncentre_of_mass = [0, 0.5, 0]\ninertia = ['1/12', 0, '1/12', 0, 0, 0]\n");
    revolute(text, numbered("bar", i), on("ground", i), '\'' + numbered("bar", i) + '\'',
             "start_rate = { angle = -1 }\n");
  }
  for (int i = 0; i < count; ++i) {
    body(text, numbered("coupler", i),
         "mass = 1\ncentre_of_mass = [0.5, 0, 0]\ninertia = [0, '1/12', '1/12', 0, 0, 0]\n");
    revolute(text, numbered("coupler", i), on(numbered("bar", i), 0, 1), '\'' + numbered("coupler", i) + '\'',
             "start_rate = { angle = 1 }\n");
    revolute(text, numbered("end", i), on(numbered("coupler", i), 1), on(numbered("bar", i + 1), 0, 1),
             "start_rate = { angle = -1 }\n");
  }
  return text.str();
}

double swing(double k, double angle, double rate, double time) {
  using Real = long double;
  constexpr int steps = 20000;  // of the classical method
  const Real h = Real(time) / steps;
  const auto force = [k](Real at) { return -Real(k) * std::sin(at); };
  Real x = angle, v = rate;
  for (int i = 0; i < steps; ++i) {
    const Real v1 = v, a1 = force(x);
    const Real v2 = v + h / 2 * a1, a2 = force(x + h / 2 * v1);
    const Real v3 = v + h / 2 * a2, a3 = force(x + h / 2 * v2);
    const Real v4 = v + h * a3, a4 = force(x + h * v3);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return static_cast<double>(x);
}

double fourbar_chain_angle(int count, double time) {
  const double n = count;
  return -swing(-9.81 * ((n + 1) / 2 + n) / ((n + 1) / 3 + n), 0.0, 1.0, time);
}

std::string fourbar_row(int count) {
  std::ostringstream text = writer("name = 'fourbar_row'\nduration = 1\nsteps = 90");
  body(text, "bell0");
  revolute(text, "bell0", "'ground'", "'bell0'");
  text << "[[drive]]\nof = 'bell0.angle'\ntype = 'sine'\noffset = '90 deg'\namplitude = '20 deg'\nfrequency = 1\n";
  for (int i = 1; i <= count; ++i) {
    const std::string coupler = numbered("coupler", i), bell = numbered("bell", i);
    body(text, coupler);
    body(text, bell);
    revolute(text, numbered("pin", i), on(numbered("bell", i - 1), 0.15), '\'' + coupler + '\'',
             "start = { angle = '-90 deg' }\n");
    revolute(text, bell, on("ground", 0.35 * i), '\'' + bell + '\'', "start = { angle = '90 deg' }\n");
    revolute(text, numbered("tip", i), on(bell, 0.15), on(coupler, 0.35));
  }
  return text.str();
}

}  // namespace koppel::app::bench
