// A force and a moment at a frame, alone or against another frame, constant or following time.
#include <cstring>

#include "characteristic.hpp"

using namespace koppel::plugin;

namespace {

struct Load {
  double wrench[6];  // [moment; force]
  bool turns;        // its axes are those of the frame that it acts on; else of the other one or of the world
  Characteristic factors;

  void evaluate(const Standing& at, const Action& out) const {
    const double factor = factors.empty() ? 1 : factors.value(at.time);
    for (int part = 0; part < 6; part += 3) {
      const double* given = wrench + part;
      for (int j = 0; j < 3; ++j) {
        const double* column = at.pose + j;
        const double turned = column[0] * given[0] + column[3] * given[1] + column[6] * given[2];
        out.wrench[part + j] = factor * (turns ? given[j] : turned);
      }
    }
  }
};

constexpr koppel_parameter parameters[] = {
    {sizeof(koppel_parameter), KOPPEL_PARAMETER_FRAME, "against", "", "Frame that answers it; the ground, if not given",
     0, 0, 0, 0, nullptr, nullptr, nullptr},
    required(KOPPEL_PARAMETER_FRAME, "on", "", "Frame at whose origin it acts"),
    optional(KOPPEL_PARAMETER_VECTOR, "force", "N", "Force", zeros),
    optional(KOPPEL_PARAMETER_VECTOR, "moment", "N m", "Moment", zeros),
    optional(KOPPEL_PARAMETER_STRING, "axes", "",
             "In whose axes both are given: `frame` (default), `world`, or `against`", nullptr),
    pairs("factors", "s", "Pairs of time in s and factor for both, times increasing"),
};

koppel_status create(const koppel_host* host, const koppel_value* values, void** instance) {
  const char* axes = values[4].count > 0 ? values[4].text : "frame";
  const bool world = std::strcmp(axes, "world") == 0, against = std::strcmp(axes, "against") == 0;
  const bool turns = std::strcmp(axes, "frame") == 0;
  if (!world && !against && !turns) {
    return reject(host, "axes", "is no choice of axes", "write \"frame\", \"world\" or \"against\"");
  }
  const bool pair = values[0].count > 0;
  if (world && pair) {
    return reject(host, "axes", "cannot be `world` where `against` is given",
                  "write \"against\" for the axes of that frame, or \"frame\"");
  }
  if (against && !pair) {
    return reject(host, "axes", "is `against`, but there is no such frame", "add `against`, or write \"world\"");
  }
  if (const koppel_status status = check_increasing(host, "factors", values[5]); status < 0) return status;
  const double *f = values[2].reals, *m = values[3].reals;
  return keep<Load>(instance, [&] {
    return Load{{m[0], m[1], m[2], f[0], f[1], f[2]}, turns, Characteristic(values[5])};
  });
}

constexpr koppel_type described = type<Load>("wrench", "Force and moment at a frame", parameters, create);
constexpr koppel_force_type table = force<Load>(described);

}  // namespace

const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL = entry<table>();
