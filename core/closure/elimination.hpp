// Rows of linear equations that each have few columns, solved for some of the columns by the others: loops meet in few
// joints, so that N of them cost O(N). Pivots are chosen once, and kept while the mechanism moves on.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace koppel {

/// The columns of each row, ascending; values come in the same order, row after row.
struct RowPattern {
  std::uint32_t columns = 0;
  std::vector<std::uint32_t> first;  ///< of each row among the entries; one more at the end
  std::vector<std::uint32_t> column;

  std::uint32_t rows() const { return static_cast<std::uint32_t>(first.size()) - 1; }
};

/// Part of the greatest entry below which a row follows from the others.
inline constexpr double redundant_row = 1e-9;
/// Least ratio of a pivot to the entries beside it (factorise()) at which a choice still serves.
inline constexpr double worn_pivot = 1e-2;

/// J = P [L, 0; *] [U, R] for the pivots chosen: `dependent` columns follow from the others where J x = b.
class Elimination {
 public:
  /// Columns from `choosable` on never depend on others: those of drives.
  Elimination(RowPattern pattern, std::uint32_t choosable);

  /// Chooses pivots where the rows have these values: few other entries in row and column (Markowitz), and not much
  /// smaller than the greatest of their row. scale: by which columns are multiplied for comparison. Rows of which less
  /// than `tolerance` of the greatest entry remains follow from the others and are left out. Makes storage anew.
  void choose(const std::vector<double>& values, const std::vector<double>& scale, double tolerance);

  const RowPattern& pattern() const { return pattern_; }
  std::uint32_t rank() const { return static_cast<std::uint32_t>(pivots_.size()); }
  /// Choosable columns that are not dependent, ascending.
  const std::vector<std::uint32_t>& independent() const { return independent_; }
  const std::vector<std::uint32_t>& dependent() const { return dependent_; }  ///< in the order of the pivots
  const std::vector<std::uint32_t>& kept() const { return kept_; }            ///< rows with a pivot, ascending
  const std::vector<std::uint32_t>& left_out() const { return left_out_; }    ///< the other rows

  /// Factorises with the pivots as chosen. Returns the least ratio of a pivot to the greatest entry that stands beside
  /// it, 0 if one vanishes or is not finite: then nothing can be solved.
  double factorise(const std::vector<double>& values);
  /// How far the rows are from losing rank where they were factorised last: the least pivot beside the greatest, in the
  /// scales of their columns.
  double margin() const { return margin_; }

  /// The greatest entry, in these scales, that was left of the rows without a pivot when pivots were chosen.
  double remainder() const { return remainder_; }

  /// x of the dependent columns from J x = b and the other columns' x. b: of all rows.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);
  /// How all columns follow from the independent ones where J x = 0: columns x independent.
  using Transfer = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  void transfer(Transfer& k) const;
  /// The same for a vector of the independent columns' x: makes all of x from these entries of it.
  void follow(Eigen::VectorXd& x) const;
  /// And transposed: adds to the independent entries what all others pass on to them.
  void gather(Eigen::VectorXd& x) const;
  /// Multipliers of the rows whose transposed rows add up to c in the dependent columns; zero for rows left out.
  void solve_transposed(const Eigen::VectorXd& c, Eigen::VectorXd& multipliers);

 private:
  struct Pivot {
    std::uint32_t row = 0, column = 0;
    std::uint32_t lower = 0, upper = 0;  ///< first of its entries in the factors; they end where the next one's begin
    double scale = 1.0;                  ///< of its column
  };
  struct Entry {
    std::uint32_t at = 0;  ///< a pivot's number in the lower factor, a column in the upper
    double value = 0.0;
  };
  void lay_out();
  std::uint32_t lower_end(std::size_t k) const;
  std::uint32_t upper_end(std::size_t k) const;

  RowPattern pattern_;
  std::uint32_t choosable_ = 0;
  std::vector<Pivot> pivots_;
  double margin_ = 1.0;
  double remainder_ = 0.0;
  std::vector<std::uint32_t> dependent_, independent_, kept_, left_out_;
  std::vector<Entry> lower_, upper_;      ///< rows of L left of the diagonal; rows of U, R over the pivot
  std::vector<double> inverse_;           ///< of the pivots
  std::vector<std::uint32_t> of_column_;  ///< pivot of a dependent column, else `none`
  std::vector<double> row_;               ///< scratch, one number for each column
  std::vector<double> sum_;               ///< scratch, one number for each pivot
};

}  // namespace koppel
