// What a body does against acceleration while others hang on it by joints that give way; in plain numbers.
#pragma once

#include "dynamics/composite_inertia.hpp"

namespace koppel {

/// [moment; force] = [[angular, mixed], [mixed^T, linear]] [angular; linear] acceleration, world axes, about the
/// body's origin: symmetric, with a mass that differs by direction.
struct ArticulatedInertia {
  PlainSymmetric3 angular;
  PlainMatrix3 mixed;
  PlainSymmetric3 linear;

  /// Of a body, or of bodies that are stuck together.
  static ArticulatedInertia of(const CompositeInertia& body) {
    const Plain3& h = body.first_moment;
    return {body.tensor, {{0, h.z, -h.y}, {-h.z, 0, h.x}, {h.y, -h.x, 0}}, {{body.mass, body.mass, body.mass}, {}}};
  }

  /// What the acceleration takes.
  PlainWrench operator()(const Plain3& alpha, const Plain3& acceleration) const {
    return {angular * alpha + mixed * acceleration, mixed.transposed_times(alpha) + linear * acceleration};
  }
  /// After a motion gives way that takes the wrench w for its unit acceleration and factor = 1/pivot.
  void reduce(double factor, const PlainWrench& w) {
    const Plain3 f = factor * w.force;
    angular.add_dyad(-factor, w.moment);
    mixed.x -= f.x * w.moment, mixed.y -= f.y * w.moment, mixed.z -= f.z * w.moment;
    linear.add_dyad(-factor, w.force);
  }
  /// Adds one whose origin is at `arm` from this one's: with d = skew(arm), mixed becomes m = b + d linear, and
  /// angular gains d m^T + (d b^T)^T.
  void add(const ArticulatedInertia& o, const Plain3& arm) {
    const PlainMatrix3& b = o.mixed;
    const Plain3 &c = o.linear.diagonal, &e = o.linear.off;
    const PlainMatrix3 m{b.x + arm.cross({c.x, e.z, e.y}), b.y + arm.cross({e.z, c.y, e.x}),
                         b.z + arm.cross({e.y, e.x, c.z})};
    const double x = arm.x, y = arm.y, z = arm.z;
    angular += o.angular;
    angular.diagonal += {y * (m.z.x + b.z.x) - z * (m.y.x + b.y.x), z * (m.x.y + b.x.y) - x * (m.z.y + b.z.y),
                         x * (m.y.z + b.y.z) - y * (m.x.z + b.x.z)};
    angular.off += {z * m.x.z - x * m.z.z + x * b.y.y - y * b.x.y, x * m.y.x - y * m.x.x + y * b.z.z - z * b.y.z,
                    y * m.z.y - z * m.y.y + z * b.x.x - x * b.z.x};
    mixed.x += m.x, mixed.y += m.y, mixed.z += m.z;
    linear += o.linear;
  }
};

}  // namespace koppel
