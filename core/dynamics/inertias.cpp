#include "dynamics/inertias.hpp"

#include "mechanism/inertia.hpp"

namespace koppel {

Result<Inertias> inertias(const Mechanism& mechanism) {
  Inertias result;
  result.of_node.resize(mechanism.nodes);
  result.has_mass.assign(mechanism.nodes, false);
  for (std::uint32_t i = 1; i < mechanism.bodies.size(); ++i) {
    KOPPEL_TRY(const koppel_inertia given, body_inertia(mechanism, BodyId{i}));
    const double* t = given.about_origin;
    Matrix3 about_origin;
    about_origin << t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2];
    const Vector3 centre(given.centre_of_mass[0], given.centre_of_mass[1], given.centre_of_mass[2]);
    result.of_node[i] = inertia_from_tensor_about_origin<double>(given.mass, centre, about_origin);
    result.has_mass[i] = given.mass > 0.0 || !result.of_node[i].about_centre.isZero(0.0);
    result.mass += given.mass;
  }
  return result;
}

}  // namespace koppel
