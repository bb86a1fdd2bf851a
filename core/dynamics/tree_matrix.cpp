#include "dynamics/tree_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace koppel {
namespace {

/// Calls visit(number of the ancestor, its depth) for the ancestors of a rate but itself, from the ground outwards.
template <typename Visit>
void for_each_ancestor(const TreeLayout& layout, std::uint32_t p, const Visit& visit) {
  for (const TreeLayout::Run& run : layout.ancestors(p)) {
    for (std::uint32_t k = 0; k < run.count; ++k) {
      if (run.first + k != p) visit(run.first + k, run.depth + k);
    }
  }
}

/// y[0..count] -= factor x[0..count]; apart from each other in memory.
inline void subtract(double factor, const double* __restrict x, double* __restrict y, std::uint32_t count) {
  for (std::uint32_t k = 0; k < count; ++k) y[k] -= factor * x[k];
}

}  // namespace

TreeMatrix::TreeMatrix(const TreeLayout& layout)
    : layout_(&layout), entries_(layout.entries(), 0.0), size_(layout.rates(), 0.0) {}

void TreeMatrix::multiply(const double* x, double* y) const {
  std::fill(y, y + layout_->mechanism().nv, 0.0);
  for (std::uint32_t p = 0; p < layout_->rates(); ++p) {
    const double* entry = row(p);
    const std::uint32_t k = layout_->rate(p);
    double sum = entry[layout_->depth(p) - 1] * x[k];
    for_each_ancestor(*layout_, p, [&](std::uint32_t ancestor, std::uint32_t depth) {
      const std::uint32_t i = layout_->rate(ancestor);
      sum += entry[depth] * x[i];
      y[i] += entry[depth] * x[k];
    });
    y[k] += sum;
  }
}

void TreeMatrix::dense(Eigen::MatrixXd& m) const {
  m.setZero(layout_->mechanism().nv, layout_->mechanism().nv);
  for (std::uint32_t p = 0; p < layout_->rates(); ++p) {
    const double* entry = row(p);
    const std::uint32_t k = layout_->rate(p);
    m(k, k) = entry[layout_->depth(p) - 1];
    for_each_ancestor(*layout_, p, [&](std::uint32_t ancestor, std::uint32_t depth) {
      const std::uint32_t i = layout_->rate(ancestor);
      m(i, k) = m(k, i) = entry[depth];
    });
  }
}

TreeFactors::TreeFactors(const TreeLayout& layout) : matrix_(layout) {}

bool TreeFactors::factorise(TreeMatrix& matrix) {
  matrix_.entries_.swap(matrix.entries_);
  matrix_.size_.swap(matrix.size_);
  return eliminate();
}

bool TreeFactors::factorise_copy(const TreeMatrix& matrix) {
  matrix_.entries_ = matrix.entries_;
  matrix_.size_ = matrix.size_;
  return eliminate();
}

bool TreeFactors::eliminate() {
  const TreeLayout& layout = matrix_.layout();
  for (std::size_t i = layout.steps().size(); i-- > 0;) {
    const TreeLayout::Step& step = layout.steps()[i];
    for (std::uint32_t k = step.rates; k-- > 0;) {
      const std::uint32_t p = step.first + k;
      double* const row = matrix_.row(p);
      const std::uint32_t diagonal = layout.depth(p) - 1;
      const double terms = static_cast<double>(step.subtree_rates + step.rates - k) + 16.0;
      if (!(row[diagonal] > terms * std::numeric_limits<double>::epsilon() * matrix_.size(p))) {
        loose_ = layout.rate(p);
        return false;
      }
      const double inverse = 1.0 / row[diagonal];
      // From the outermost ancestor inwards: it still needs the entries of those before it.
      const auto runs = layout.ancestors(p);
      for (std::size_t r = runs.size(); r-- > 0;) {
        for (std::uint32_t j = runs[r].count; j-- > 0;) {
          const std::uint32_t ancestor = runs[r].first + j, depth = runs[r].depth + j;
          if (ancestor == p) continue;
          const double factor = row[depth] * inverse;
          subtract(factor, row, matrix_.row(ancestor), depth + 1);
          row[depth] = factor;
        }
      }
    }
  }
  return true;
}

/// x = L^-T x.
void TreeFactors::outwards_in(double* x) const {
  const TreeLayout& layout = matrix_.layout();
  for (std::uint32_t p = layout.rates(); p-- > 0;) {
    const double value = x[layout.rate(p)];
    if (value == 0.0) continue;
    const double* const row = matrix_.row(p);
    for_each_ancestor(layout, p, [&](std::uint32_t ancestor, std::uint32_t depth) {
      x[layout.rate(ancestor)] -= row[depth] * value;
    });
  }
}

/// x = L^-1 x.
void TreeFactors::inwards_out(double* x) const {
  const TreeLayout& layout = matrix_.layout();
  for (std::uint32_t p = 0; p < layout.rates(); ++p) {
    const double* const row = matrix_.row(p);
    double sum = 0.0;
    for_each_ancestor(
        layout, p, [&](std::uint32_t ancestor, std::uint32_t depth) { sum += row[depth] * x[layout.rate(ancestor)]; });
    x[layout.rate(p)] -= sum;
  }
}

void TreeFactors::solve(double* x) const {
  outwards_in(x);
  for (std::uint32_t p = 0; p < matrix_.layout().rates(); ++p) x[matrix_.layout().rate(p)] /= pivot(p);
  inwards_out(x);
}

void TreeFactors::solve(double* x, std::uint32_t count) const {
  const TreeLayout& layout = matrix_.layout();
  const auto row_of = [&](std::uint32_t p) { return x + std::size_t{count} * layout.rate(p); };
  for (std::uint32_t p = layout.rates(); p-- > 0;) {
    const double* const row = matrix_.row(p);
    for_each_ancestor(layout, p, [&](std::uint32_t ancestor, std::uint32_t depth) {
      subtract(row[depth], row_of(p), row_of(ancestor), count);
    });
  }
  for (std::uint32_t p = 0; p < layout.rates(); ++p) {
    const double* const row = matrix_.row(p);
    double* const own = row_of(p);
    const double inverse = 1.0 / pivot(p);
    for (std::uint32_t k = 0; k < count; ++k) own[k] *= inverse;
    for_each_ancestor(layout, p, [&](std::uint32_t ancestor, std::uint32_t depth) {
      subtract(row[depth], row_of(ancestor), own, count);
    });
  }
}

void TreeFactors::half_solve(double* x) const {
  outwards_in(x);
  for (std::uint32_t p = 0; p < matrix_.layout().rates(); ++p) x[matrix_.layout().rate(p)] /= std::sqrt(pivot(p));
}

void TreeFactors::other_half_solve(double* x) const {
  for (std::uint32_t p = 0; p < matrix_.layout().rates(); ++p) x[matrix_.layout().rate(p)] /= std::sqrt(pivot(p));
  inwards_out(x);
}

double TreeFactors::log_determinant() const {
  double sum = 0.0;
  for (std::uint32_t p = 0; p < matrix_.layout().rates(); ++p) sum += std::log(pivot(p));
  return sum;
}

}  // namespace koppel
