#include "dynamics/derivative.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace koppel {
namespace {

constexpr int levels = 18;       // of halved steps
constexpr int orders = 6;        // of extrapolation: by then what is left has the size of rounding
constexpr double first = 0.125;  // step over the scale
constexpr double good = 1e-13;   // part of the column's greatest entry at which finer steps gain nothing
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Numbers at steps that are halved one after the other, extrapolated to a step of zero: their errors go with the step
/// to the power of `lowest`, and every second one above.
class Table {
 public:
  Table(Eigen::Index size, int lowest) : lowest_(lowest) {
    for (auto* row : {&now_, &before_}) row->fill(Eigen::VectorXd::Zero(size));
  }

  void add(Eigen::VectorXd value) {
    std::swap(now_, before_);
    now_[0] = std::move(value);
    double power = std::exp2(lowest_);
    for (int m = 1; m <= std::min(count_, orders); ++m, power *= 4.0) {
      now_[static_cast<std::size_t>(m)] = at(m - 1) + (at(m - 1) - coarse(m)) / (power - 1.0);
    }
    ++count_;
  }

  int count() const { return count_; }
  /// Extrapolated m times, of the last step; and what it was extrapolated from: fine is at(m - 1).
  const Eigen::VectorXd& at(int m) const { return now_[static_cast<std::size_t>(m)]; }
  const Eigen::VectorXd& coarse(int m) const { return before_[static_cast<std::size_t>(m - 1)]; }

 private:
  int lowest_, count_ = 0;
  std::array<Eigen::VectorXd, orders + 1> now_, before_;
};

/// The slopes of y along one number of x.
class Column {
 public:
  explicit Column(const Eigen::VectorXd& middle)
      : middle_(middle),
        slopes_(middle.size(), 2),
        bends_(middle.size(), 1),
        best_(Eigen::VectorXd::Zero(middle.size())),
        error_(Eigen::VectorXd::Constant(middle.size(), infinity)) {}

  /// Takes in y at plus and minus a step, half as long as the last one.
  void add(const Eigen::VectorXd& ahead, const Eigen::VectorXd& behind, double step) {
    slopes_.add((ahead - behind) / (2.0 * step));
    // Half of what the slopes ahead and behind differ by: at a step of zero only rounding and corners are left of it.
    bends_.add((ahead - 2.0 * middle_ + behind) / (2.0 * step));
    const int count = slopes_.count();
    if (count == 1) best_ = slopes_.at(0);
    for (int m = 1; m < std::min(count, orders + 1); ++m) {
      for (Eigen::Index i = 0; i < best_.size(); ++i) {
        const double next = slopes_.at(m)[i];
        const double noise = std::abs(bends_.at(m)[i]) + eps * (std::abs(ahead[i]) + std::abs(behind[i])) / step;
        const double error = std::abs(next - slopes_.at(m - 1)[i]) + std::abs(next - slopes_.coarse(m)[i]) + noise;
        if (!(error < error_[i])) continue;
        error_[i] = error;
        best_[i] = next;
      }
    }
  }

  bool is_good() const { return count() > 2 && (error_.array() <= good * greatest()).all(); }
  int count() const { return slopes_.count(); }

  void write(Eigen::Ref<Eigen::VectorXd> value, Eigen::Ref<Eigen::VectorXd> error) const {
    value = best_;
    error = error_.cwiseMax(4.0 * eps * best_.cwiseAbs());
  }

 private:
  double greatest() const { return best_.size() == 0 ? 0.0 : best_.lpNorm<Eigen::Infinity>(); }

  const Eigen::VectorXd& middle_;
  Table slopes_, bends_;
  Eigen::VectorXd best_, error_;
};

}  // namespace

bool differentiate(const VectorFunction& f, const Eigen::VectorXd& x, const Eigen::VectorXd& scales, Derivative& result,
                   Eigen::Index& failed) {
  Eigen::VectorXd middle, ahead, behind, at;
  failed = -1;
  if (!f(x, middle)) return false;
  result.value.resize(middle.size(), x.size());
  result.error.resize(middle.size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    std::optional<Column> column;
    double step = first * scales[j];
    for (int k = 0; k < levels && !(column && column->is_good()); ++k, step *= 0.5) {
      at = x;
      at[j] = x[j] + step;
      const double up = at[j] - x[j];
      bool there = f(at, ahead);
      at[j] = x[j] - up;
      there = there && f(at, behind);
      // Steps must be halved one after the other: what came before a gap is of no use.
      if (!there) column.reset();
      if (there && !column) column.emplace(middle);
      if (there) column->add(ahead, behind, up);
    }
    if (!column || column->count() < 2) {
      failed = j;
      return false;
    }
    column->write(result.value.col(j), result.error.col(j));
  }
  return true;
}

}  // namespace koppel
