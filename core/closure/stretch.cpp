#include "closure/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "closure/decompositions.hpp"

namespace koppel {
namespace {

constexpr double spacing = 5e-3;  // of nodes beside a change point
constexpr double node_places[] = {-3.0, -2.0, -1.0, 1.0, 2.0, 3.0};
constexpr double beside = 1.5 * spacing;
constexpr double steepest = 3.0;  // that a singular value is taken to fall along the arc
constexpr double weak = 1e-3;     // a singular value below this is that which vanishes at the change point

/// Coefficients of the polynomial through values (rows) at the nodes, in distances from x over the spacing.
Eigen::MatrixXd expand(const std::vector<double>& at, double x, const Eigen::MatrixXd& values) {
  const auto n = static_cast<Eigen::Index>(at.size());
  Eigen::MatrixXd powers(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double z = (at[static_cast<std::size_t>(i)] - x) / spacing;
    powers(i, 0) = 1.0;
    for (Eigen::Index k = 1; k < n; ++k) powers(i, k) = powers(i, k - 1) * z;
  }
  return Eigen::FullPivLU<Eigen::MatrixXd>(powers).solve(values);
}

double value_of(const Eigen::VectorXd& coefficients, double z) {
  double value = 0.0;
  for (Eigen::Index k = coefficients.size() - 1; k >= 0; --k) value = value * z + coefficients[k];
  return value;
}

Eigen::VectorXd derivative(const Eigen::VectorXd& coefficients) {
  Eigen::VectorXd result(coefficients.size() - 1);
  for (Eigen::Index k = 0; k < result.size(); ++k) result[k] = static_cast<double>(k + 1) * coefficients[k + 1];
  return result;
}

/// The root of a polynomial that Newton's method finds from zero, no further than `most` from it.
double root_of(const Eigen::VectorXd& coefficients, double most) {
  const Eigen::VectorXd slope = derivative(coefficients);
  double z = 0.0;
  for (int i = 0; i < 30; ++i) {
    const double next = std::clamp(z - value_of(coefficients, z) / value_of(slope, z), -most, most);
    if (!std::isfinite(next) || std::abs(next - z) <= 1e-13) return next;
    z = next;
  }
  return z;
}

}  // namespace

Stretch::Stretch(Curve& curve, CurvePoint a, CurvePoint b, double length)
    : curve_(curve), a_(std::move(a)), b_(std::move(b)), length_(length) {
  end_ = curve_.offset(a_, b_.q, b_.parameter);
  slope_ = b_.tangent / a_.tangent.dot(b_.tangent);
}

/// Offset from a at a distance: a cubic through both ends.
Eigen::VectorXd Stretch::guess(double distance, Eigen::VectorXd* slope) const {
  const double x = distance / length_;
  const Eigen::VectorXd first = length_ * a_.tangent, last = length_ * slope_;
  const Eigen::VectorXd square = 3.0 * end_ - 2.0 * first - last, cube = first + last - 2.0 * end_;
  if (slope != nullptr) *slope = (first + x * (2.0 * square + 3.0 * x * cube)) / length_;
  return x * (first + x * (square + x * cube));
}

bool Stretch::close_at(double distance, CurvePoint& point) {
  Eigen::VectorXd slope;
  const Eigen::VectorXd where = guess(distance, &slope);
  point = CurvePoint{};
  curve_.displace(a_, where, point.q, point.parameter);
  return curve_.close_across(a_, a_.tangent, distance, point.q, point.parameter) && curve_.look(point, slope);
}

bool Stretch::at(double distance, CurvePlace& place) {
  place = CurvePlace{};
  if (!nodes_.empty() && std::abs(distance - middle_) <= beside) return interpolate(distance, place);
  return close_at(distance, place.point);
}

double Stretch::arc(double distance) {
  // Boole's rule for the integral of the arc length by the distance.
  constexpr double weights[] = {7.0, 32.0, 12.0, 32.0, 7.0};
  double sum = 0.0;
  CurvePlace place;
  for (int i = 0; i < 5; ++i) {
    double along = 1.0;
    if (i > 0) {
      if (!at(distance * i / 4.0, place)) return std::numeric_limits<double>::quiet_NaN();
      along = a_.tangent.dot(place.point.tangent);
    }
    sum += weights[i] / along;
  }
  return sum * distance / 90.0;
}

std::optional<double> Stretch::find_limit() {
  const Eigen::Index last = curve_.unknowns();
  const double from = a_.tangent[last], to = b_.tangent[last];
  if (from == 0.0 || (from < 0.0) == (to < 0.0)) return std::nullopt;
  CurvePlace place;
  const double distance = root_between(
      [&](double x) { return at(x, place) ? place.point.tangent[last] : std::numeric_limits<double>::quiet_NaN(); },
      0.0, from, length_, to);
  if (std::isnan(distance)) return std::nullopt;
  return distance;
}

const std::optional<ChangePoint>& Stretch::find_change_point() {
  if (searched_ || curve_.rank() == 0 || a_.motions.cols() != b_.motions.cols()) return change_;
  searched_ = true;
  const bool crossed = curve_.orientation(a_, a_) * curve_.orientation(a_, b_) < 0.0;
  // Where the rank drops by two at once nothing is seen from outside but that it comes near.
  if (!crossed && a_.weakest + b_.weakest > steepest * length_) return change_;
  const double first = length_ * a_.weakest / (a_.weakest + b_.weakest);
  CurvePlace place;
  if (!find_nodes(first, crossed) || !interpolate(middle_, place)) {
    nodes_.clear();
    hopped_ = crossed;
    return change_;
  }
  ChangePoint change;
  change.point = place.point;
  change.at = middle_;
  find_branches(change);
  change_ = std::move(change);
  return change_;
}

/// Brings nodes to stand about the drop of the rank that they show.
bool Stretch::find_nodes(double middle, bool crossed) {
  for (int attempt = 0; attempt < 12 && take_nodes(middle); ++attempt) {
    const double root = root_of_rank(crossed);
    if (!std::isfinite(root)) return false;
    const bool settled = std::abs(root - middle) <= 0.1 * spacing;
    middle = std::clamp(root, -3.0 * spacing, length_ + 3.0 * spacing);
    if (!crossed && middle != root) return false;
    if (!settled) continue;
    middle_ = middle;
    return crossed || (0.0 < middle && middle < length_);
  }
  return false;
}

bool Stretch::take_nodes(double middle) {
  nodes_.clear();
  middle_ = middle;
  for (const double place : node_places) {
    Node node;
    node.at = middle + place * spacing;
    if (!close_at(node.at, node.point)) {
      nodes_.clear();
      return false;
    }
    nodes_.push_back(std::move(node));
  }
  return true;
}

/// Where the rank drops, by a polynomial through the nodes. crossed: by one; then a function changes its sign. Else the
/// smallest singular value that counts must have the minimum zero.
double Stretch::root_of_rank(bool crossed) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> places;
  Eigen::MatrixXd values(count, 1);
  const CurvePoint& reference = nodes_[3].point;
  for (int i = 0; i < count; ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    places.push_back(node.at);
    values(i, 0) = crossed ? curve_.rank_function(reference, node.point) : node.point.weakest * node.point.weakest;
  }
  if (!values.allFinite()) return none;
  const Eigen::VectorXd c = expand(places, middle_, values);
  if (crossed) return middle_ + spacing * root_of(c, 8.0);
  const double z = root_of(derivative(c), 8.0);
  const double least = std::abs(value_of(c, z)), here = values.maxCoeff();
  if (std::abs(z) < 3.0 && !(least <= 1e-7 * here)) return none;
  return middle_ + spacing * z;
}

/// A place beside a change point, from the nodes.
bool Stretch::interpolate(double distance, CurvePlace& place) {
  std::vector<double> places;
  Eigen::MatrixXd offsets(count, curve_.unknowns() + 1);
  const auto take = [&](const CurvePoint& from) {
    places.clear();
    for (int i = 0; i < count; ++i) {
      const Node& node = nodes_[static_cast<std::size_t>(i)];
      places.push_back(node.at);
      offsets.row(i) = curve_.offset(from, node.point.q, node.point.parameter).transpose();
    }
  };
  CurvePoint point = nodes_[2].point;
  take(nodes_[2].point);
  const Eigen::VectorXd where = expand(places, distance, offsets).row(0);
  curve_.displace(nodes_[2].point, where, point.q, point.parameter);
  if (!settle(point)) return false;
  // Once more, about the place itself: there derivatives of offsets are rates.
  take(point);
  const Eigen::MatrixXd c = expand(places, distance, offsets);
  const Eigen::VectorXd first = c.row(1).transpose() / spacing;
  const Eigen::VectorXd second = 2.0 * c.row(2).transpose() / (spacing * spacing);
  const double speed = first.norm();
  const Eigen::VectorXd tangent = first / speed;
  point.curvature.resize(0);
  if (!curve_.look(point, tangent)) {
    if (curve_.plugin_failed()) return false;
  }
  point.tangent = tangent;
  place.second = (second - tangent * tangent.dot(second)) / (speed * speed);
  place.beside_change_point = true;
  place.point = std::move(point);
  return true;
}

/// Takes what interpolation left open out of the equations that are not about to depend on others.
bool Stretch::settle(CurvePoint& point) {
  CurvePoint from;
  for (int i = 0; i < 3; ++i) {
    if (!curve_.linearise(point.q, point.parameter)) return false;
    const Eigen::MatrixXd unknown = curve_.extended().leftCols(curve_.unknowns());
    Eigen::BDCSVD<Eigen::MatrixXd> svd(unknown, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(5.0 * weak);
    const Eigen::VectorXd residual = curve_.work().equations.residual;
    Eigen::VectorXd change = Eigen::VectorXd::Zero(curve_.unknowns() + 1);
    change.head(curve_.unknowns()) = -svd.solve(residual);
    from.q = point.q;
    from.parameter = point.parameter;
    curve_.displace(from, change, point.q, point.parameter);
  }
  return curve_.linearise(point.q, point.parameter) && curve_.work().equations.error() <= 1e-12;
}

/// Tangents of the branches that meet: those combinations of the null vectors along which the equations hold to second
/// order too.
void Stretch::find_branches(ChangePoint& change) {
  CurvePoint& here = change.point;
  change.branches = {here.tangent};
  if (!curve_.linearise(here.q, here.parameter)) return;
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(curve_.extended(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Index strong = curve_.rank() - 1;
  const Eigen::MatrixXd motions = svd.matrixV().rightCols(curve_.unknowns() + 1 - strong);
  const Eigen::MatrixXd stresses = svd.matrixU().rightCols(curve_.extended().rows() - strong);
  const Eigen::MatrixXd form = second_order_form(here, motions, stresses);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(form);
  // Isolated freedoms have eigenvalue zero; the two that decide are at the ends.
  const auto& values = eigen.eigenvalues();
  const double low = values[0], high = values[values.size() - 1];
  if (!(low < 0.0 && high > 0.0) || std::min(-low, high) <= 1e-4 * std::max(-low, high)) return;
  const Eigen::VectorXd x = motions * eigen.eigenvectors().col(0) / std::sqrt(-low);
  const Eigen::VectorXd y = motions * eigen.eigenvectors().col(values.size() - 1) / std::sqrt(high);
  Eigen::VectorXd one = (x + y).normalized(), other = (x - y).normalized();
  if (std::abs(one.dot(here.tangent)) > std::abs(other.dot(here.tangent))) std::swap(one, other);
  // The other branch goes on in the direction in which the parameter was going.
  const Eigen::Index last = curve_.unknowns();
  const double sense = std::abs(one[last]) > 1e-6 ? one[last] * here.tangent[last] : one.dot(here.tangent);
  change.branches.push_back(sense < 0.0 ? Eigen::VectorXd(-one) : one);
}

Eigen::MatrixXd Stretch::second_order_form(const CurvePoint& at, const Eigen::MatrixXd& motions,
                                           const Eigen::MatrixXd& stresses) {
  constexpr double h = 1e-4;
  const Eigen::Index n = motions.cols();
  Eigen::MatrixXd forms(n * n, stresses.cols());
  Eigen::VectorXd q;
  double parameter = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(curve_.extended().rows(), curve_.extended().cols());
    for (const double sign : {1.0, -1.0}) {
      curve_.displace(at, sign * h * motions.col(i), q, parameter);
      if (!curve_.linearise(q, parameter)) return Eigen::MatrixXd::Zero(n, n);
      change += sign / (2.0 * h) * curve_.extended();
    }
    forms.middleRows(i * n, n) = (stresses.transpose() * change * motions).transpose();
  }
  // Of equations that are redundant everywhere nothing is left; those that become so here all say the same.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(forms, Eigen::ComputeThinU);
  const Eigen::VectorXd greatest = svd.matrixU().col(0) * svd.singularValues()[0];
  const Eigen::MatrixXd form = greatest.reshaped(n, n);
  return 0.5 * (form + form.transpose());
}

std::optional<Stretch> Stretch::on_branch(Curve& curve, const ChangePoint& from, const Eigen::VectorXd& tangent) {
  CurvePoint a = from.point, b;
  a.tangent = tangent;
  a.curvature.resize(0);
  constexpr double far = 8.0 * spacing;
  curve.displace(a, far * tangent, b.q, b.parameter);
  if (!curve.close_across(a, tangent, far, b.q, b.parameter) || !curve.look(b, tangent)) return std::nullopt;
  Stretch stretch(curve, a, b, far);
  if (!stretch.take_nodes(0.0)) return std::nullopt;
  return stretch;
}

}  // namespace koppel
