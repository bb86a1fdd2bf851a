// Derivatives of what can only be evaluated, with an estimate of their error.
#pragma once

#include <functional>

#include <Eigen/Core>

namespace koppel {

/// dy/dx, rows of y by columns of x, and what each entry may be wrong by.
struct Derivative {
  Eigen::MatrixXd value, error;
};

/// y at x; false: there is none.
using VectorFunction = std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

/// By central differences whose steps are halved from an eighth of `scales` on, extrapolated to a step of zero
/// (Richardson); of each entry the one that its neighbours in the table confirm best (Ridders 1982). Half of what the
/// slopes on the two sides differ by is extrapolated alike and counts as error: rounding of y, or the corner of a
/// force. Steps at which there is no y are left out; `failed` is the column in which there are too few, else -1. False:
/// no y at x, or a failed column.
bool differentiate(const VectorFunction& f, const Eigen::VectorXd& x, const Eigen::VectorXd& scales, Derivative& result,
                   Eigen::Index& failed);

}  // namespace koppel
