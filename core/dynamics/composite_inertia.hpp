// Mass properties in world axes about a node's origin, as sums of them are formed; in plain numbers.
#pragma once

#include "spatial/plain.hpp"
#include "spatial/spatial_inertia.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// A wrench in registers.
struct PlainWrench {
  Plain3 moment, force;

  PlainWrench() = default;
  PlainWrench(const Plain3& m, const Plain3& f) : moment(m), force(f) {}
  explicit PlainWrench(const Wrench& w) : moment(w.moment), force(w.force) {}
  void store(Wrench& w) const {
    moment.store(w.moment);
    force.store(w.force);
  }
  PlainWrench& operator+=(const PlainWrench& o) {
    moment += o.moment, force += o.force;
    return *this;
  }
  PlainWrench& operator-=(const PlainWrench& o) {
    moment -= o.moment, force -= o.force;
    return *this;
  }
  PlainWrench operator+(const PlainWrench& o) const { return {moment + o.moment, force + o.force}; }
  friend PlainWrench operator*(double f, const PlainWrench& w) { return {f * w.moment, f * w.force}; }
  /// With its moment about a point from which this one's lies at `arm`.
  PlainWrench moved(const Plain3& arm) const { return {moment + arm.cross(force), force}; }
};

/// A body together with all bodies beyond, as if their joints were stuck.
struct CompositeInertia {
  double mass = 0.0;       ///< [kg]
  Plain3 first_moment;     ///< mass times centre [kg m]
  PlainSymmetric3 tensor;  ///< of inertia [kg m^2]

  /// Of one body, whose rotation is given.
  static CompositeInertia of(const SpatialInertia& body, const PlainMatrix3& rotation) {
    const Plain3 centre = rotation * Plain3(body.centre);
    CompositeInertia result{body.mass, body.mass * centre, PlainSymmetric3::of(body.about_centre).turned(rotation)};
    result.add_steiner(result.first_moment, centre);
    return result;
  }
  /// Adds one whose origin is at `arm` from this one's.
  void add(const CompositeInertia& o, const Plain3& arm) {
    // With a centre that is neither here nor there: the arm twice with its moment, once with its mass.
    tensor += o.tensor;
    const Plain3 half = o.first_moment + (0.5 * o.mass) * arm;
    const Plain3 along(2.0 * half.x * arm.x, 2.0 * half.y * arm.y, 2.0 * half.z * arm.z);
    tensor.diagonal += {along.y + along.z, along.z + along.x, along.x + along.y};
    tensor.off -= {half.y * arm.z + half.z * arm.y, half.z * arm.x + half.x * arm.z, half.x * arm.y + half.y * arm.x};
    first_moment += o.first_moment + o.mass * arm;
    mass += o.mass;
  }
  /// What the acceleration of the origin takes, without regard of velocities.
  PlainWrench operator()(const Plain3& angular, const Plain3& linear) const {
    return {tensor * angular + first_moment.cross(linear), mass * linear + angular.cross(first_moment)};
  }

 private:
  /// Adds |c|^2 m - m c c^T, h = m c.
  void add_steiner(const Plain3& h, const Plain3& c) {
    const Plain3 along(h.x * c.x, h.y * c.y, h.z * c.z);
    tensor.diagonal += {along.y + along.z, along.z + along.x, along.x + along.y};
    tensor.off -= {h.y * c.z, h.z * c.x, h.x * c.y};
  }
};

}  // namespace koppel
