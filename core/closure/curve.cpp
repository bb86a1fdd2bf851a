#include "closure/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "closure/decompositions.hpp"
#include "closure/newton.hpp"

namespace koppel {
namespace {

constexpr double counts = 1e-8;           // singular values above this times the largest are not rounding
constexpr double at_rest = 1e-7;          // a direction of which less is left than this cannot be followed
constexpr double largest_turn = 0.25;     // of the tangent in one step
constexpr double largest_surprise = 0.2;  // correction of a step, of its length
constexpr int corrections = 14;
constexpr double rounding = 1e-15;
constexpr double rounding_region = 1e-12;

}  // namespace

Curve::Curve(Work& work, InputWay way)
    : work_(work),
      way_(std::move(way)),
      rows_(static_cast<Eigen::Index>(work.mechanism->rows)),
      unknowns_(static_cast<Eigen::Index>(work.mechanism->unknowns)),
      extended_(rows_, unknowns_ + 1) {}

bool Curve::failed() {
  plugin_failed_ = true;
  if (way_.culprit() != nullptr) work_.equations.blame(*way_.culprit());
  return false;
}

bool Curve::linearise(Eigen::VectorXd& q, double parameter) {
  const Mechanism& m = mechanism();
  Equations& equations = work_.equations;
  work_.factorised = false;
  if (!way_.evaluate(parameter)) return failed();
  for (std::size_t i = 0; i < m.inputs.size(); ++i) q[m.inputs[i].q] = way_.value()[static_cast<Eigen::Index>(i)];
  if (!equations.evaluate(q, way_.time()) || !equations.time_rate(work_.rhs)) return failed();
  equations.evaluate_jacobian();
  extended_.leftCols(unknowns_) = equations.jacobian.leftCols(unknowns_);
  auto by_parameter = extended_.col(unknowns_);
  by_parameter = way_.time_rate() * work_.rhs;
  for (std::size_t i = 0; i < m.inputs.size(); ++i) {
    const std::uint32_t rate = m.inputs[i].v;
    const std::int32_t column = m.column_of_rate[rate];
    by_parameter += way_.rate()[static_cast<Eigen::Index>(i)] / m.rate_scale[rate] * equations.jacobian.col(column);
  }
  by_parameter *= way_.scale();
  return true;
}

Eigen::VectorXd Curve::offset(const CurvePoint& from, const Eigen::VectorXd& q, double parameter) const {
  const Mechanism& m = mechanism();
  Eigen::VectorXd delta(m.nv), result(unknowns_ + 1);
  difference(m, from.q, q, delta);
  for (Eigen::Index i = 0; i < unknowns_; ++i) {
    const std::uint32_t rate = m.rate_of_column[static_cast<std::size_t>(i)];
    result[i] = delta[rate] / m.rate_scale[rate];
  }
  result[unknowns_] = (parameter - from.parameter) / way_.scale();
  return result;
}

void Curve::displace(const CurvePoint& from, const Eigen::VectorXd& offset, Eigen::VectorXd& q, double& parameter) {
  const Mechanism& m = mechanism();
  Eigen::VectorXd delta = Eigen::VectorXd::Zero(m.nv);
  for (Eigen::Index i = 0; i < unknowns_; ++i) {
    const std::uint32_t rate = m.rate_of_column[static_cast<std::size_t>(i)];
    delta[rate] = offset[i] * m.rate_scale[rate];
  }
  Eigen::VectorXd result(m.nq);
  integrate(m, from.q, delta, result);
  parameter = from.parameter + way_.scale() * offset[unknowns_];
  q = result;
}

bool Curve::close_across(const CurvePoint& base, const Eigen::VectorXd& direction, double distance, Eigen::VectorXd& q,
                         double& parameter) {
  Eigen::MatrixXd matrix(rows_ + 1, unknowns_ + 1);
  Eigen::VectorXd rhs(rows_ + 1);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  factors.setThreshold(1e-11);
  CurvePoint here;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < corrections; ++i) {
    if (!linearise(q, parameter)) return false;
    rhs << -work_.equations.residual, distance - direction.dot(offset(base, q, parameter));
    const double error = rhs.lpNorm<Eigen::Infinity>();
    if (error <= rounding || (error <= rounding_region && error > 0.5 * before)) break;
    before = error;
    matrix << extended_, direction.transpose();
    const Eigen::VectorXd change = factors.compute(matrix).solve(rhs);
    if (!(change.lpNorm<Eigen::Infinity>() < 0.5)) return false;
    here.q = q;
    here.parameter = parameter;
    displace(here, change, q, parameter);
  }
  if (!linearise(q, parameter)) return false;
  return work_.equations.error() <= closed_limit;
}

bool Curve::look(CurvePoint& point, const Eigen::VectorXd& along) {
  if (!linearise(point.q, point.parameter)) return false;
  if (!work_.equations.cut_coordinates(point.q)) return failed();
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(extended_, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const auto& values = svd.singularValues();
  rank_ = std::max<Eigen::Index>(rank_, (values.array() > counts * values[0]).count());
  point.motions = svd.matrixV().rightCols(unknowns_ + 1 - rank_);
  point.stresses = svd.matrixU().rightCols(rows_ - rank_);
  point.largest = values[0];
  point.weakest = rank_ > 0 ? values[rank_ - 1] : 0.0;
  if (rank_ > 0) {
    point.weak_motion = svd.matrixV().col(rank_ - 1);
    point.weak_stress = svd.matrixU().col(rank_ - 1);
  }
  point.tangent = point.motions * (point.motions.transpose() * along);
  const double left = point.tangent.norm();
  if (!(left > at_rest * along.norm())) return false;
  point.tangent /= left;
  return true;
}

bool Curve::begin(const Eigen::VectorXd& q, double parameter, const Eigen::VectorXd& along, CurvePoint& point) {
  point = CurvePoint{};
  point.q = q;
  point.parameter = parameter;
  return look(point, along);
}

bool Curve::step(const CurvePoint& from, double length, CurvePoint& to) {
  Eigen::VectorXd predicted = length * from.tangent;
  if (from.curvature.size() > 0) predicted += length * length / 2.0 * from.curvature;
  to = CurvePoint{};
  displace(from, predicted, to.q, to.parameter);
  if (!close_across(from, from.tangent, length, to.q, to.parameter)) return false;
  const Eigen::VectorXd gone = offset(from, to.q, to.parameter);
  if (!((gone - predicted).norm() <= largest_surprise * std::abs(length))) return false;
  if (!look(to, from.tangent)) return false;
  const double turn = std::acos(std::min(1.0, from.tangent.dot(to.tangent)));
  if (!(turn <= largest_turn)) return false;
  to.curvature = (to.tangent - from.tangent) / (length > 0.0 ? gone.norm() : -gone.norm());
  return true;
}

Eigen::MatrixXd Curve::bordered(const CurvePoint& reference, bool with_weak) const {
  const Eigen::Index more = with_weak ? 1 : 0;
  const Eigen::Index stresses = reference.stresses.cols(), motions = reference.motions.cols();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows_ + motions + more, unknowns_ + 1 + stresses + more);
  matrix.topLeftCorner(rows_, unknowns_ + 1) = extended_;
  matrix.block(0, unknowns_ + 1, rows_, stresses) = reference.stresses;
  matrix.block(rows_, 0, motions, unknowns_ + 1) = reference.motions.transpose();
  if (with_weak) {
    matrix.col(matrix.cols() - 1).head(rows_) = reference.weak_stress;
    matrix.row(matrix.rows() - 1).head(unknowns_ + 1) = reference.weak_motion.transpose();
  }
  return matrix;
}

double Curve::orientation(const CurvePoint& reference, const CurvePoint& at) {
  Eigen::VectorXd q = at.q;
  if (!linearise(q, at.parameter)) return 0.0;
  const Eigen::MatrixXd matrix = bordered(reference, false);
  if (matrix.rows() != matrix.cols()) return 0.0;
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(matrix);
  double sign = static_cast<double>(lu.permutationP().determinant());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) sign = lu.matrixLU()(i, i) < 0.0 ? -sign : sign;
  return sign;
}

double Curve::rank_function(const CurvePoint& reference, const CurvePoint& at) {
  Eigen::VectorXd q = at.q;
  if (!linearise(q, at.parameter)) return std::nan("");
  const Eigen::MatrixXd matrix = bordered(reference, true);
  if (matrix.rows() != matrix.cols()) return std::nan("");
  Eigen::VectorXd last = Eigen::VectorXd::Unit(matrix.rows(), matrix.rows() - 1);
  return Eigen::PartialPivLU<Eigen::MatrixXd>(matrix).solve(last)[matrix.cols() - 1];
}

}  // namespace koppel
