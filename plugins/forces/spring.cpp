// A spring and damper between the origins of two frames: it acts along the line between them.
#include <cmath>

#include "characteristic.hpp"

using namespace koppel::plugin;

namespace {

struct Spring {
  double stiffness, damping, length, preload;
  Characteristic characteristic;

  void evaluate(const Standing& at, const Action& out) const;
  double energy(const Standing& at) const;
  double dissipation(const Standing& at) const;
  double elastic(double stretch) const { return preload + stiffness * stretch + characteristic.value(stretch); }
};

constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_FRAME, "from", "", "Frame at whose origin the spring begins"),
    required(KOPPEL_PARAMETER_FRAME, "to", "", "Frame at whose origin it ends"),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "stiffness", "N/m", "Stiffness", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "damping", "N s/m", "Damping", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "length", "m", "Length at which the stretch is zero", zeros)),
    optional(KOPPEL_PARAMETER_REAL, "preload", "N", "Tension at that length", zeros),
    pairs("table", "m", "Pairs of stretch in m and tension in N, added to the rest; stretches increase"),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  if (const koppel_status status = check_increasing(host, "table", values[6]); status < 0) return status;
  return keep<Spring>(instance, [&] {
    return Spring{real(values[2]), real(values[3]), real(values[4]), real(values[5]), Characteristic(values[6])};
  });
}

/// From the first origin to the second: length, and direction in the axes of the second frame. Where the points
/// coincide there is no direction, and then no force.
struct Span {
  double length;
  double n[3];

  explicit Span(const double* pose) : length(std::hypot(pose[9], pose[10], pose[11])), n{} {
    if (!(length > 0)) return;
    for (int j = 0; j < 3; ++j) {
      n[j] = (pose[j] * pose[9] + pose[3 + j] * pose[10] + pose[6 + j] * pose[11]) / length;
    }
  }
  double rate(const double* twist) const { return n[0] * twist[3] + n[1] * twist[4] + n[2] * twist[5]; }
};

void Spring::evaluate(const Standing& at, const Action& out) const {
  const Span span(at.pose);
  const double tension = elastic(span.length - length) + damping * span.rate(at.twist);
  for (int j = 0; j < 3; ++j) {
    out.wrench[j] = 0;
    out.wrench[3 + j] = -tension * span.n[j];
  }
}

double Spring::energy(const Standing& at) const {
  const double stretch = Span(at.pose).length - length;
  return stretch * (preload + stiffness * stretch / 2) + characteristic.integral(stretch);
}

double Spring::dissipation(const Standing& at) const {
  const double rate = Span(at.pose).rate(at.twist);
  return damping * rate * rate;
}

constexpr koppel_type described = type<Spring>("spring", "Spring and damper between two points", parameters, create);
constexpr koppel_force_type table = force<Spring>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();
