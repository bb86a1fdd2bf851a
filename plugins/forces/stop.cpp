// Stops at the ends of a coordinate's way. They push back and never hold: the force of Hunt and Crossley (J. Appl.
// Mech. 42, 1975) grows from zero with the depth, whatever the speed at which a stop is met.
#include <algorithm>

#include "standard.hpp"

using namespace koppel::plugin;

namespace {

struct Stop {
  bool has_lower, has_upper;
  double lower, upper;  // [rad] or [m]
  double stiffness, damping;

  static constexpr std::size_t switch_count = 2;

  /// How deep the coordinate stands in a stop, and how fast it goes deeper.
  struct Contact {
    double depth, rate;
  };
  Contact at_lower(double q, double v) const { return {has_lower ? std::max(lower - q, 0.0) : 0.0, -v}; }
  Contact at_upper(double q, double v) const { return {has_upper ? std::max(q - upper, 0.0) : 0.0, v}; }

  double push(const Contact& c) const { return stiffness * c.depth * std::max(1 + damping * c.rate, 0.0); }
  /// What push() does beyond the elastic force. Where the coordinate draws back so fast that nothing pushes it, the
  /// stop relaxes alone.
  double lost(const Contact& c) const { return stiffness * c.depth * c.rate * std::max(damping * c.rate, -1.0); }

  void evaluate(const Standing& at, const Action& out) const {
    *out.effort = push(at_lower(*at.q, *at.v)) - push(at_upper(*at.q, *at.v));
  }
  double energy(const Standing& at) const {
    const double low = at_lower(*at.q, 0).depth, high = at_upper(*at.q, 0).depth;
    return stiffness * (low * low + high * high) / 2;
  }
  double dissipation(const Standing& at) const { return lost(at_lower(*at.q, *at.v)) + lost(at_upper(*at.q, *at.v)); }
  void switches(const Standing& at, double* out) const {
    out[0] = has_lower ? *at.q - lower : 1;
    out[1] = has_upper ? upper - *at.q : 1;
  }
};

constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_COORDINATES, "of", "", "Coordinate that it acts on"),
    optional(KOPPEL_PARAMETER_REAL, "lower", "", "Value at which the lower stop is met, in rad or m", nullptr),
    optional(KOPPEL_PARAMETER_REAL, "upper", "", "Value at which the upper stop is met, in rad or m", nullptr),
    not_negative(required(KOPPEL_PARAMETER_REAL, "stiffness", "N m/rad or N/m", "Stiffness")),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "damping", "s/rad or s/m",
                          "Damping: at this times the speed the force is greater, going in, than the elastic one",
                          zeros)),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  const bool has_lower = values[1].count > 0, has_upper = values[2].count > 0;
  if (!has_lower && !has_upper) {
    return reject(host, nullptr, "there is neither `lower` nor `upper`", "say where the stop is");
  }
  const double lower = has_lower ? real(values[1]) : 0, upper = has_upper ? real(values[2]) : 0;
  if (has_lower && has_upper && lower > upper) {
    return reject(host, "lower", "lies above `upper`", "give the lower stop the smaller value");
  }
  return keep<Stop>(instance,
                    [&] { return Stop{has_lower, has_upper, lower, upper, real(values[3]), real(values[4])}; });
}

constexpr koppel_type described = type<Stop>("stop", "Elastic stops of a coordinate", parameters, create);
constexpr koppel_force_type table = force<Stop>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();
