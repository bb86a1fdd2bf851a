#include "dynamics/elimination.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace koppel {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double threshold = 0.1;  // of the greatest entry of its row: what a pivot must have

using SparseRow = std::map<std::uint32_t, double>;

/// The pivot with the least product of other entries in its row and its column; nothing if no row has any left.
struct Choice {
  std::size_t row = none;
  std::uint32_t column = none;
  double value = 0.0;
};

Choice choose_pivot(const std::vector<SparseRow>& rows, const std::vector<bool>& done, std::uint32_t choosable,
                    const std::vector<double>& scale, double least) {
  std::vector<std::uint32_t> count(choosable, 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (done[i]) continue;
    for (const auto& [column, value] : rows[i]) {
      if (column < choosable) ++count[column];
    }
  }
  Choice best;
  double best_cost = std::numeric_limits<double>::infinity(), best_part = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (done[i]) continue;
    double greatest = 0.0;
    for (const auto& [column, value] : rows[i]) {
      if (column < choosable) greatest = std::max(greatest, std::abs(value) * scale[column]);
    }
    if (!(greatest > least)) continue;
    for (const auto& [column, value] : rows[i]) {
      if (column >= choosable) continue;
      const double part = std::abs(value) * scale[column] / greatest;
      if (part < threshold) continue;
      const double cost = static_cast<double>(rows[i].size() - 1) * static_cast<double>(count[column] - 1);
      if (cost > best_cost || (cost == best_cost && part <= best_part)) continue;
      best = {i, column, value};
      best_cost = cost;
      best_part = part;
    }
  }
  return best;
}

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
  std::vector<bool> done(rows.size(), false);
  pivots_.clear();
  for (;;) {
    const Choice pivot = choose_pivot(rows, done, choosable_, scale, tolerance * greatest);
    if (pivot.column == none) break;
    done[pivot.row] = true;
    pivots_.push_back({static_cast<std::uint32_t>(pivot.row), pivot.column, 0, 0, scale[pivot.column]});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (done[i]) continue;
      const auto under = rows[i].find(pivot.column);
      if (under == rows[i].end()) continue;
      const double factor = under->second / pivot.value;
      rows[i].erase(under);
      for (const auto& [column, value] : rows[pivot.row]) {
        if (column != pivot.column) rows[i][column] -= factor * value;
      }
    }
  }
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
