// Twists and their rates as sums of them are formed: world axes, all about one point; in plain numbers.
#pragma once

#include "dynamics/composite_inertia.hpp"

namespace koppel {

/// A twist, or a rate of one, in registers.
struct PlainTwist {
  Plain3 angular, linear;

  PlainTwist operator+(const PlainTwist& o) const { return {angular + o.angular, linear + o.linear}; }
  PlainTwist& operator+=(const PlainTwist& o) {
    angular += o.angular, linear += o.linear;
    return *this;
  }
  friend PlainTwist operator*(double f, const PlainTwist& t) { return {f * t.angular, f * t.linear}; }

  /// The Lie bracket: the rate of a twist that is carried along with this one.
  PlainTwist cross(const PlainTwist& o) const {
    return {angular.cross(o.angular), angular.cross(o.linear) + linear.cross(o.angular)};
  }
  /// The rate of a wrench that is carried along.
  PlainWrench cross(const PlainWrench& w) const {
    return {angular.cross(w.moment) + linear.cross(w.force), angular.cross(w.force)};
  }
  double power(const PlainWrench& w) const { return angular.dot(w.moment) + linear.dot(w.force); }
};

/// What the masses of one or many bodies that move would meet as Coriolis forces if the axes turned.
struct CoriolisInertia {
  PlainMatrix3 moment;  ///< integral of velocity times place^T over the mass [kg m^2/s]
  Plain3 momentum;      ///< [N s]

  static CoriolisInertia of(const CompositeInertia& body, const PlainTwist& velocity) {
    const Plain3 &h = body.first_moment, &turn = velocity.angular, &slide = velocity.linear;
    // The second moments of the mass are half the trace of the tensor less the tensor.
    const Plain3 &d = body.tensor.diagonal, &o = body.tensor.off;
    const double half = 0.5 * body.tensor.trace();
    return {{h.x * slide + turn.cross({half - d.x, -o.z, -o.y}), h.y * slide + turn.cross({-o.z, half - d.y, -o.x}),
             h.z * slide + turn.cross({-o.y, -o.x, half - d.z})},
            body.mass * slide + turn.cross(h)};
  }
  CoriolisInertia& operator+=(const CoriolisInertia& other) {
    moment.x += other.moment.x, moment.y += other.moment.y, moment.z += other.moment.z;
    momentum += other.momentum;
    return *this;
  }
  double trace() const { return moment.x.x + moment.y.y + moment.z.z; }

  /// Twice the integral of [place; 1] x (turn x velocity) over the mass.
  PlainWrench operator()(const Plain3& turn) const {
    return {2.0 * (trace() * turn - moment * turn), 2.0 * turn.cross(momentum)};
  }
  /// The vector whose product with a turn is the power of that wrench on a twist.
  Plain3 transposed(const PlainTwist& twist) const {
    const Plain3& a = twist.angular;
    return 2.0 * (momentum.cross(twist.linear) + trace() * a - moment.transposed_times(a));
  }
};

}  // namespace koppel
