// What core does with blocks of coordinates, whatever joint they belong to: integrate, difference, normalise.
// q holds the numbers, v the rates; quaternion rates are angular velocities in outlet axes, so that a small change is a
// rotation vector applied on the right.
#pragma once

#include "plugin/type.hpp"
#include "spatial/types.hpp"

namespace koppel {

/// result = q moved by the tangent vector delta (rates times a time). result may be q.
void integrate_block(BlockKind kind, const double* q, const double* delta, double* result);

/// The tangent vector that leads from `from` to `to`: integrate(from, delta) = to. Of quaternions the shorter way.
void difference_block(BlockKind kind, const double* from, const double* to, double* delta);

/// Brings quaternions and unit vectors to unit length; a vector of length zero becomes the neutral one.
void normalise_block(BlockKind kind, double* q);

/// d(integrate(q, delta))/d(delta) at delta = 0: coordinate_count x rate_count, row by row.
void tangent_block(BlockKind kind, const double* q, double* jacobian);

/// The neutral value: zero, the identity, e_z.
void neutral_block(BlockKind kind, double* q);

}  // namespace koppel
