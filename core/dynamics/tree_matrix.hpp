// Symmetric matrices whose entries vanish but for rates of which one lies between the other and the ground: mass
// matrices of trees. They factorise without fill-in from the outermost rate inwards (Featherstone, Efficient
// factorization of the joint-space inertia matrix for branched kinematic trees, 2005).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamics/tree_layout.hpp"

namespace koppel {

/// The row of a rate holds its entries with its ancestors, from the ground outwards, and ends on the diagonal. Vectors
/// are nv long, in the order of the state; entries of cut joints are left alone, but where said otherwise.
class TreeMatrix {
 public:
  /// Borrows the layout. Zero.
  explicit TreeMatrix(const TreeLayout& layout);

  const TreeLayout& layout() const { return *layout_; }

  /// Of the rate with this number in the layout: depth(p) entries.
  double* row(std::uint32_t p) { return entries_.data() + layout_->first_entry(p); }
  const double* row(std::uint32_t p) const { return entries_.data() + layout_->first_entry(p); }

  /// The size of the terms that cancel in a diagonal entry; what rounding leaves of it is measured by this. An entry
  /// that was not formed by differences is its own size.
  double& size(std::uint32_t p) { return size_[p]; }
  double size(std::uint32_t p) const { return size_[p]; }

  /// y = M x; zero for cut joints.
  void multiply(const double* x, double* y) const;
  /// nv x nv, zero for cut joints.
  void dense(Eigen::MatrixXd& m) const;

 private:
  friend class TreeFactors;
  const TreeLayout* layout_;
  std::vector<double> entries_, size_;
};

/// M = L^T D L, with ones on the diagonal of L.
class TreeFactors {
 public:
  explicit TreeFactors(const TreeLayout& layout);

  /// Factorises in place: takes the entries over, those of `matrix` must be written anew. False if a pivot is not
  /// greater than its rounding error: then nothing resists in loose(), and nothing may be solved.
  ///
  /// A pivot is what resists in a rate while all rates beyond it give way. It comes from its diagonal entry by one
  /// subtraction for each of the n rates beyond, of terms that add up to no more than the entry; its error is therefore
  /// below (n + 16) 2^-52 times the size of the entry, the 16 for forming it.
  bool factorise(TreeMatrix& matrix);
  /// The same, with `matrix` as it is.
  bool factorise_copy(const TreeMatrix& matrix);

  /// The rate (in v) whose pivot vanishes.
  std::uint32_t loose() const { return loose_; }
  /// By number in the layout.
  double pivot(std::uint32_t p) const { return matrix_.row(p)[matrix_.layout().depth(p) - 1]; }

  /// x = M^-1 x.
  void solve(double* x) const;
  /// x = D^-1/2 L^-T x: its square is x^T M^-1 x. Entries beyond the rates between the entries of x that are not zero
  /// and the ground stay zero.
  void half_solve(double* x) const;
  /// x = L^-1 D^-1/2 x: solve() is half_solve() and this.
  void other_half_solve(double* x) const;
  /// X = M^-1 X, nv rows of `count` numbers each, row by row.
  void solve(double* x, std::uint32_t count) const;
  /// The logarithm of the determinant.
  double log_determinant() const;

 private:
  bool eliminate();
  void outwards_in(double* x) const;
  void inwards_out(double* x) const;

  TreeMatrix matrix_;
  std::uint32_t loose_ = 0;
};

}  // namespace koppel
