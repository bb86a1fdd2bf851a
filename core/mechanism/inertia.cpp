#include "mechanism/inertia.hpp"

#include <algorithm>
#include <cmath>

namespace koppel {
namespace {

bool sensible(const koppel_inertia& inertia) {
  const auto finite = [](double x) { return std::isfinite(x); };
  return finite(inertia.mass) && inertia.mass >= 0.0 &&
         std::all_of(std::begin(inertia.centre_of_mass), std::end(inertia.centre_of_mass), finite) &&
         std::all_of(std::begin(inertia.about_origin), std::end(inertia.about_origin), finite);
}

}  // namespace

Result<koppel_inertia> body_inertia(const Mechanism& mechanism, BodyId id) {
  koppel_inertia inertia{};
  inertia.struct_size = sizeof(inertia);
  const Body& body = mechanism.bodies[id.index()];
  if (body.type == nullptr) return inertia;
  KOPPEL_TRY(const Instance instance, body.type->create(body.values));
  const void* pointer = instance.get();
  if (body.type->calls.inertia(1, &pointer, &inertia) < 0 || !sensible(inertia)) {
    return tl::make_unexpected(make_error(Code::plugin_misbehaved, "body " + body.name,
                                          "inertia() of " + body.type->name + " (" + body.type->origin +
                                              ") failed or gave a mass or inertia that cannot be",
                                          "report it to the author of the plugin"));
  }
  return inertia;
}

}  // namespace koppel
