#include "dynamics/closure_rows.hpp"

#include <algorithm>

namespace koppel {
namespace {

RowPattern pattern_of(const Mechanism& mechanism) {
  std::vector<std::vector<std::uint32_t>> rows(mechanism.rows);
  for (const Relation& relation : mechanism.relations) {
    for_each_entry(relation, [&](std::uint32_t row, const PathRate& rate) { rows[row].push_back(rate.column); });
  }
  RowPattern pattern;
  pattern.columns = mechanism.columns;
  pattern.first.push_back(0);
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    pattern.first.push_back(static_cast<std::uint32_t>(pattern.column.size()));
  }
  return pattern;
}

}  // namespace

ClosureRows::ClosureRows(const Mechanism& mechanism)
    : mechanism_(mechanism), pattern_(pattern_of(mechanism)), values_(pattern_.column.size(), 0.0) {
  for (const std::uint32_t rate : mechanism.rate_of_column) scales_.push_back(mechanism.rate_scale[rate]);
  for (const Relation& relation : mechanism.relations) {
    for_each_entry(relation, [&](std::uint32_t row, const PathRate& rate) {
      const auto begin = pattern_.column.begin() + pattern_.first[row];
      const auto end = pattern_.column.begin() + pattern_.first[row + 1];
      order_.push_back(static_cast<std::size_t>(std::lower_bound(begin, end, rate.column) - pattern_.column.begin()));
    });
    block_.resize(std::max(block_.size(), relation.rows * (relation.path.size() + relation.coupled.size())));
  }
}

void ClosureRows::evaluate(const Equations& equations) {
  std::fill(values_.begin(), values_.end(), 0.0);
  std::size_t place = 0;
  for (std::size_t i = 0; i < mechanism_.relations.size(); ++i) {
    const Relation& relation = mechanism_.relations[i];
    equations.relation_jacobian(i, block_.data());
    const std::size_t count = relation.rows * (relation.path.size() + relation.coupled.size());
    for (std::size_t k = 0; k < count; ++k) values_[order_[place++]] += block_[k];
  }
}

void ClosureRows::add_product(const Eigen::VectorXd& x, Eigen::VectorXd& result) const {
  for (std::uint32_t row = 0; row < pattern_.rows(); ++row) {
    for (std::uint32_t k = pattern_.first[row]; k < pattern_.first[row + 1]; ++k) {
      result[row] += values_[k] * x[mechanism_.rate_of_column[pattern_.column[k]]];
    }
  }
}

void ClosureRows::subtract_transposed(const Eigen::VectorXd& multipliers, Eigen::VectorXd& efforts) const {
  for (std::uint32_t row = 0; row < pattern_.rows(); ++row) {
    if (multipliers[row] == 0.0) continue;
    for (std::uint32_t k = pattern_.first[row]; k < pattern_.first[row + 1]; ++k) {
      efforts[mechanism_.rate_of_column[pattern_.column[k]]] -= multipliers[row] * values_[k];
    }
  }
}

}  // namespace koppel
