#include "closure/elimination.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace koppel {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double threshold = 0.1;  // of the greatest entry of its row: what a pivot must have

using SparseRow = std::map<std::uint32_t, double>;

/// Rows on their way to a triangular form, and the pivot that each of them offers.
class Remaining {
 public:
  /// least: what the scaled entries of a row must exceed for it to have a pivot.
  Remaining(std::vector<SparseRow> rows, std::uint32_t choosable, const std::vector<double>& scale, double least)
      : rows_(std::move(rows)), rows_with_(choosable), offers_(rows_.size()), scale_(scale), least_(least) {
    for (std::uint32_t i = 0; i < rows_.size(); ++i) {
      for (const auto& [column, value] : rows_[i]) {
        if (column < choosable) rows_with_[column].insert(i);
      }
    }
    for (std::uint32_t i = 0; i < rows_.size(); ++i) offer(i);
  }

  /// Few other entries in row and column come first, then what is great in its row.
  struct Pivot {
    double cost = 0.0, less = 0.0;  ///< less: minus its part of the row's greatest entry
    std::uint32_t row = none, column = none;
    bool operator<(const Pivot& other) const {
      return std::tie(cost, less, row, column) < std::tie(other.cost, other.less, other.row, other.column);
    }
  };

  /// Takes the best pivot and its column out of all other rows; nothing if none is left.
  Pivot eliminate() {
    if (queue_.empty()) return {};
    const Pivot pivot = *queue_.begin();
    const SparseRow row = std::move(rows_[pivot.row]);
    std::set<std::uint32_t> affected;
    for (const auto& [column, value] : row) {
      if (column >= rows_with_.size()) continue;
      rows_with_[column].erase(pivot.row);
      affected.insert(rows_with_[column].begin(), rows_with_[column].end());
    }
    for (const std::uint32_t i : rows_with_[pivot.column]) subtract(row, pivot.column, i);
    rows_with_[pivot.column].clear();
    withdraw(pivot.row);
    for (const std::uint32_t i : affected) offer(i);
    return pivot;
  }

  /// The greatest scaled entry of the rows that offer no pivot.
  double rest() const {
    double greatest = 0.0;
    for (const SparseRow& row : rows_) greatest = std::max(greatest, greatest_of(row));
    return greatest;
  }

 private:
  double greatest_of(const SparseRow& row) const {
    double greatest = 0.0;
    for (const auto& [column, value] : row) {
      if (column < rows_with_.size()) greatest = std::max(greatest, std::abs(value) * scale_[column]);
    }
    return greatest;
  }

  void subtract(const SparseRow& row, std::uint32_t column, std::uint32_t from) {
    const double factor = rows_[from].at(column) / row.at(column);
    for (const auto& [other, value] : row) {
      rows_[from][other] -= factor * value;
      if (other < rows_with_.size() && other != column) rows_with_[other].insert(from);
    }
    rows_[from].erase(column);
  }

  void withdraw(std::uint32_t i) {
    if (offers_[i].row != none) queue_.erase(offers_[i]);
    offers_[i] = {};
  }

  void offer(std::uint32_t i) {
    withdraw(i);
    const double greatest = greatest_of(rows_[i]);
    if (!(greatest > least_)) return;
    for (const auto& [column, value] : rows_[i]) {
      if (column >= rows_with_.size()) continue;
      const double part = std::abs(value) * scale_[column] / greatest;
      if (part < threshold) continue;
      const double cost = static_cast<double>(rows_[i].size() - 1) * static_cast<double>(rows_with_[column].size() - 1);
      const Pivot pivot{cost, -part, i, column};
      if (offers_[i].row == none || pivot < offers_[i]) offers_[i] = pivot;
    }
    if (offers_[i].row != none) queue_.insert(offers_[i]);
  }

  std::vector<SparseRow> rows_;
  std::vector<std::set<std::uint32_t>> rows_with_;  ///< rows that have no pivot yet, by choosable column
  std::vector<Pivot> offers_;
  std::set<Pivot> queue_;
  const std::vector<double>& scale_;
  double least_;
};

}  // namespace

Elimination::Elimination(RowPattern pattern, std::uint32_t choosable)
    : pattern_(std::move(pattern)), choosable_(choosable), row_(pattern_.columns, 0.0) {}

void Elimination::choose(const std::vector<double>& values, const std::vector<double>& scale, double tolerance) {
  std::vector<SparseRow> rows(pattern_.rows());
  double greatest = 0.0;
  for (std::uint32_t i = 0; i < pattern_.rows(); ++i) {
    for (std::uint32_t k = pattern_.first[i]; k < pattern_.first[i + 1]; ++k) {
      if (values[k] != 0.0) rows[i][pattern_.column[k]] = values[k];
      greatest = std::max(greatest, std::abs(values[k]) * scale[pattern_.column[k]]);
    }
  }
  Remaining remaining(std::move(rows), choosable_, scale, tolerance * greatest);
  pivots_.clear();
  for (auto pivot = remaining.eliminate(); pivot.row != none; pivot = remaining.eliminate()) {
    pivots_.push_back({pivot.row, pivot.column, 0, 0, scale[pivot.column]});
  }
  remainder_ = remaining.rest();
  lay_out();
}

/// Numbers the columns by what they are, and finds the entries of the factors: those of the rows and their fill.
void Elimination::lay_out() {
  dependent_.clear();
  independent_.clear();
  kept_.clear();
  left_out_.clear();
  lower_.clear();
  upper_.clear();
  of_column_.assign(pattern_.columns, none);
  std::vector<bool> used(pattern_.rows(), false);
  for (std::size_t k = 0; k < pivots_.size(); ++k) {
    dependent_.push_back(pivots_[k].column);
    of_column_[pivots_[k].column] = static_cast<std::uint32_t>(k);
    used[pivots_[k].row] = true;
  }
  for (std::uint32_t i = 0; i < choosable_; ++i) {
    if (of_column_[i] == none) independent_.push_back(i);
  }
  for (std::uint32_t i = 0; i < pattern_.rows(); ++i) {
    (used[i] ? kept_ : left_out_).push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> upper(pivots_.size());
  for (std::size_t k = 0; k < pivots_.size(); ++k) {
    Pivot& pivot = pivots_[k];
    std::set<std::uint32_t> columns(pattern_.column.begin() + pattern_.first[pivot.row],
                                    pattern_.column.begin() + pattern_.first[pivot.row + 1]);
    std::set<std::uint32_t> before;  // pivots whose rows are subtracted
    for (const std::uint32_t column : columns) {
      if (of_column_[column] < k) before.insert(of_column_[column]);
    }
    for (auto j = before.begin(); j != before.end(); ++j) {
      for (const std::uint32_t column : upper[*j]) {
        columns.insert(column);
        if (of_column_[column] < k) before.insert(of_column_[column]);  // later than *j: its row is upper
      }
    }
    pivot.lower = static_cast<std::uint32_t>(lower_.size());
    pivot.upper = static_cast<std::uint32_t>(upper_.size());
    for (const std::uint32_t j : before) lower_.push_back({j, 0.0});
    for (const std::uint32_t column : columns) {
      if (of_column_[column] <= k) continue;
      upper[k].push_back(column);
      upper_.push_back({column, 0.0});
    }
  }
  inverse_.assign(pivots_.size(), 0.0);
  sum_.assign(pivots_.size(), 0.0);
}

std::uint32_t Elimination::lower_end(std::size_t k) const {
  return k + 1 < pivots_.size() ? pivots_[k + 1].lower : static_cast<std::uint32_t>(lower_.size());
}

std::uint32_t Elimination::upper_end(std::size_t k) const {
  return k + 1 < pivots_.size() ? pivots_[k + 1].upper : static_cast<std::uint32_t>(upper_.size());
}

double Elimination::factorise(const std::vector<double>& values) {
  double least = 1.0, smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (std::size_t k = 0; k < pivots_.size(); ++k) {
    const Pivot& pivot = pivots_[k];
    const std::uint32_t lower = lower_end(k), upper = upper_end(k);
    row_[pivot.column] = 0.0;
    for (std::uint32_t i = pivot.upper; i < upper; ++i) row_[upper_[i].at] = 0.0;
    for (std::uint32_t i = pivot.lower; i < lower; ++i) row_[pivots_[lower_[i].at].column] = 0.0;
    for (std::uint32_t i = pattern_.first[pivot.row]; i < pattern_.first[pivot.row + 1]; ++i) {
      row_[pattern_.column[i]] = values[i];
    }
    for (std::uint32_t i = pivot.lower; i < lower; ++i) {
      const std::uint32_t j = lower_[i].at;
      const double factor = row_[pivots_[j].column];
      lower_[i].value = factor;
      const std::uint32_t end = upper_end(j);
      for (std::uint32_t e = pivots_[j].upper; e < end; ++e) row_[upper_[e].at] -= factor * upper_[e].value;
    }
    const double value = row_[pivot.column];
    double greatest = std::abs(value);
    for (std::uint32_t i = pivot.upper; i < upper; ++i) greatest = std::max(greatest, std::abs(row_[upper_[i].at]));
    if (!(std::abs(value) > 0.0) || !std::isfinite(greatest)) return 0.0;
    least = std::min(least, std::abs(value) / greatest);
    smallest = std::min(smallest, std::abs(value) * pivot.scale);
    largest = std::max(largest, std::abs(value) * pivot.scale);
    inverse_[k] = 1.0 / value;
    for (std::uint32_t i = pivot.upper; i < upper; ++i) upper_[i].value = row_[upper_[i].at] * inverse_[k];
  }
  margin_ = largest > 0.0 ? smallest / largest : 1.0;
  return least;
}

void Elimination::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  for (std::size_t k = 0; k < pivots_.size(); ++k) {
    double sum = b[pivots_[k].row];
    for (std::uint32_t i = pivots_[k].lower; i < lower_end(k); ++i) sum -= lower_[i].value * sum_[lower_[i].at];
    sum_[k] = sum * inverse_[k];
  }
  for (std::size_t k = pivots_.size(); k-- > 0;) {
    double sum = sum_[k];
    for (std::uint32_t i = pivots_[k].upper; i < upper_end(k); ++i) sum -= upper_[i].value * x[upper_[i].at];
    x[pivots_[k].column] = sum;
  }
}

void Elimination::transfer(Transfer& k) const {
  k.setZero();
  for (std::size_t i = 0; i < independent_.size(); ++i) k(independent_[i], static_cast<Eigen::Index>(i)) = 1.0;
  for (std::size_t p = pivots_.size(); p-- > 0;) {
    auto row = k.row(pivots_[p].column);
    for (std::uint32_t i = pivots_[p].upper; i < upper_end(p); ++i) row -= upper_[i].value * k.row(upper_[i].at);
  }
}

void Elimination::follow(Eigen::VectorXd& x) const {
  for (std::size_t p = pivots_.size(); p-- > 0;) {
    double sum = 0.0;
    for (std::uint32_t i = pivots_[p].upper; i < upper_end(p); ++i) sum -= upper_[i].value * x[upper_[i].at];
    x[pivots_[p].column] = sum;
  }
}

void Elimination::gather(Eigen::VectorXd& x) const {
  for (std::size_t p = 0; p < pivots_.size(); ++p) {
    const double here = x[pivots_[p].column];
    for (std::uint32_t i = pivots_[p].upper; i < upper_end(p); ++i) x[upper_[i].at] -= upper_[i].value * here;
  }
}

void Elimination::solve_transposed(const Eigen::VectorXd& c, Eigen::VectorXd& multipliers) {
  for (std::size_t k = 0; k < pivots_.size(); ++k) sum_[k] = c[pivots_[k].column];
  for (std::size_t k = 0; k < pivots_.size(); ++k) {
    for (std::uint32_t i = pivots_[k].upper; i < upper_end(k); ++i) {
      const std::uint32_t later = of_column_[upper_[i].at];
      if (later != none) sum_[later] -= upper_[i].value * sum_[k];
    }
  }
  multipliers.setZero();
  for (std::size_t k = pivots_.size(); k-- > 0;) {
    const double value = sum_[k] * inverse_[k];
    multipliers[pivots_[k].row] = value;
    for (std::uint32_t i = pivots_[k].lower; i < lower_end(k); ++i) sum_[lower_[i].at] -= lower_[i].value * value;
  }
}

}  // namespace koppel
