// Families of polynomials whose numbers of solutions are known.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "closure/continuation.hpp"

namespace koppel::test {

inline double uniform(std::mt19937_64& random) { return 2.0 * static_cast<double>(random() >> 11U) * 0x1p-53 - 1.0; }
inline Complex uniform_complex(std::mt19937_64& random) {
  const double re = uniform(random);
  return {re, uniform(random)};
}

/// Polynomials: a sum of terms p[parameter] * product of unknowns, for each row.
class Polynomials : public ContinuationProblem {
 public:
  struct Term {
    Eigen::Index parameter;
    std::vector<Eigen::Index> unknowns;  // a square has its unknown twice
  };
  std::vector<std::vector<Term>> rows;
  Eigen::Index coefficients = 0;

  void add(std::size_t row, std::vector<Eigen::Index> factors) {
    rows.resize(std::max(rows.size(), row + 1));
    rows[row].push_back({coefficients++, std::move(factors)});
  }

  Eigen::Index unknowns() const override { return static_cast<Eigen::Index>(rows.size()); }
  Eigen::Index point_size() const override { return unknowns(); }
  Eigen::Index parameters() const override { return coefficients; }

  void evaluate(const ComplexVector& x, const ComplexVector& p, ComplexVector& residual, ComplexMatrix* jacobian,
                const ComplexVector* dp, ComplexVector* along_dp) override {
    residual.setZero();
    if (jacobian) jacobian->setZero();
    if (along_dp) along_dp->setZero();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      for (const Term& term : rows[k]) {
        Complex value = 1.0;
        for (const Eigen::Index i : term.unknowns) value *= x[i];
        residual[row] += p[term.parameter] * value;
        if (along_dp) (*along_dp)[row] += (*dp)[term.parameter] * value;
        if (!jacobian) continue;
        for (std::size_t i = 0; i < term.unknowns.size(); ++i) {
          Complex others = p[term.parameter];
          for (std::size_t j = 0; j < term.unknowns.size(); ++j) {
            if (j != i) others *= x[term.unknowns[j]];
          }
          (*jacobian)(row, term.unknowns[i]) += others;
        }
      }
    }
  }
  void move(const ComplexVector& x, const ComplexVector& delta, ComplexVector& result) const override {
    result = x + delta;
  }
  void lift(const ComplexVector&, const ComplexVector& rate, ComplexVector& derivative, ComplexVector&) const override {
    derivative = rate;
  }
  void fingerprint(const ComplexVector& x, ComplexVector& print) const override { print = x; }

  bool seed(std::mt19937_64& random, ComplexVector& x, ComplexVector& p) override {
    for (Complex& value : x) value = uniform_complex(random);
    for (Complex& value : p) value = uniform_complex(random);
    ComplexVector residual(unknowns());
    evaluate(x, p, residual, nullptr, nullptr, nullptr);
    // The last term of each row is mended.
    for (std::size_t k = 0; k < rows.size(); ++k) {
      Complex value = 1.0;
      for (const Eigen::Index i : rows[k].back().unknowns) value *= x[i];
      p[rows[k].back().parameter] -= residual[static_cast<Eigen::Index>(k)] / value;
    }
    return true;
  }
};

/// n general quadrics; coefficients: squares and products in the order 00, 01, ..., 11, 12, ..., then linear, constant.
inline Polynomials quadrics(Eigen::Index n) {
  Polynomials result;
  for (Eigen::Index row = 0; row < n; ++row) {
    const auto k = static_cast<std::size_t>(row);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = i; j < n; ++j) result.add(k, {i, j});
    }
    for (Eigen::Index i = 0; i < n; ++i) result.add(k, {i});
    result.add(k, {});
  }
  return result;
}

/// Cyclic n-roots with general coefficients.
inline Polynomials cyclic(Eigen::Index n) {
  Polynomials result;
  for (Eigen::Index degree = 1; degree < n; ++degree) {
    for (Eigen::Index first = 0; first < n; ++first) {
      std::vector<Eigen::Index> factors;
      for (Eigen::Index i = 0; i < degree; ++i) factors.push_back((first + i) % n);
      result.add(static_cast<std::size_t>(degree - 1), factors);
    }
  }
  std::vector<Eigen::Index> all;
  for (Eigen::Index i = 0; i < n; ++i) all.push_back(i);
  result.add(static_cast<std::size_t>(n - 1), all);
  result.add(static_cast<std::size_t>(n - 1), {});
  return result;
}

}  // namespace koppel::test
