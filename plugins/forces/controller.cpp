// A PID controller of a coordinate. The integral of the error is an internal state; it rests while the effort is at its
// limit and the error would drive it further.
#include <algorithm>
#include <cmath>
#include <limits>

#include "characteristic.hpp"

using namespace koppel::plugin;

namespace {

constexpr double none = std::numeric_limits<double>::infinity();

struct Controller {
  double proportional, integral, derivative;
  double setpoint;  // [rad] or [m], where there is no course
  Characteristic course;
  double limit;  // [N m] or [N]; infinite: none

  static constexpr koppel_internal_state states[] = {internal_state("integral", "rad s or m s")};
  static constexpr std::size_t switch_count = 2;

  double error(const Standing& at) const { return setpoint + course.value(at.time) - *at.q; }
  double asked(const Standing& at) const {
    const double error_rate = course.slope(at.time) - *at.v;
    return proportional * error(at) + integral * *at.states + derivative * error_rate;
  }

  void evaluate(const Standing& at, const Action& out) const {
    const double effort = asked(at), pushed = integral * error(at);
    *out.effort = std::clamp(effort, -limit, limit);
    const bool rests = std::abs(effort) > limit && effort * pushed > 0;
    *out.state_rates = rests ? 0 : error(at);
  }
  void switches(const Standing& at, double* out) const {
    const bool limited = limit < none;
    out[0] = limited ? limit - asked(at) : 1;
    out[1] = limited ? limit + asked(at) : 1;
  }
};

constexpr koppel_parameter parameters[] = {
    required(KOPPEL_PARAMETER_COORDINATES, "of", "", "Coordinate that it acts on"),
    optional(KOPPEL_PARAMETER_REAL, "setpoint", "", "Value that the coordinate shall have, in rad or m", nullptr),
    pairs("course", "s", "Or: pairs of time in s and value in rad or m, times increasing"),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "proportional", "N m/rad or N/m", "Gain of the error", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "integral", "N m/(rad s) or N/(m s)", "Gain of its integral", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "derivative", "N m s/rad or N s/m", "Gain of its rate", zeros)),
    not_negative(optional(KOPPEL_PARAMETER_REAL, "limit", "N m or N", "Greatest effort; any, if not given", nullptr)),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  const bool fixed = values[1].count > 0, moving = values[2].count > 0;
  if (fixed && moving) return reject(host, "course", "is given beside `setpoint`", "keep one of the two");
  if (!fixed && !moving) {
    return reject(host, nullptr, "there is neither `setpoint` nor `course`",
                  "say what value the coordinate shall have");
  }
  if (const koppel_status status = check_increasing(host, "course", values[2]); status < 0) return status;
  return keep<Controller>(instance, [&] {
    return Controller{real(values[3]),           real(values[4]),
                      real(values[5]),           fixed ? real(values[1]) : 0.0,
                      Characteristic(values[2]), values[6].count > 0 ? real(values[6]) : none};
  });
}

constexpr koppel_type described = type<Controller>("controller", "PID controller of a coordinate", parameters, create);
constexpr koppel_force_type table = force<Controller>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();
