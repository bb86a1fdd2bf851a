#include "closure/product_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace koppel {
namespace {

constexpr std::size_t power(std::size_t n) { return n == 0 ? 1 : 3 * power(n - 1); }
constexpr std::size_t largest = power(ProductForm::most_variables);

/// Coefficients of 1, f1, f2 from values at three sample points.
std::array<double, 3> from_samples(VariableKind kind, double length, const std::array<double, 3>& v) {
  if (kind == VariableKind::turn) {
    // A third of a turn apart: 0, 2 pi / 3, -2 pi / 3.
    return {(v[0] + v[1] + v[2]) / 3.0, (2.0 * v[0] - v[1] - v[2]) / 3.0, (v[1] - v[2]) / std::numbers::sqrt3};
  }
  // -length, 0, length.
  return {v[1], (v[2] - v[0]) / (2.0 * length), (v[0] - 2.0 * v[1] + v[2]) / (2.0 * length * length)};
}

double sample(VariableKind kind, double length, std::size_t i) {
  constexpr double third = 2.0 / 3.0 * std::numbers::pi;
  if (kind == VariableKind::turn) return i == 0 ? 0.0 : i == 1 ? third : -third;
  return (static_cast<double>(i) - 1.0) * length;
}

/// Values of a tensor and its two time derivatives, contracted with one variable after another.
struct Jet {
  std::array<double, largest / 3> value, rate, acceleration;
};

/// The first contraction: only the variable moves.
void contract_first(const double* c, std::size_t m, const CoordinateBasis& b, Jet& jet) {
  const double *c1 = c + m, *c2 = c + 2 * m;
  for (std::size_t j = 0; j < m; ++j) {
    jet.value[j] = c[j] + b.value[0] * c1[j] + b.value[1] * c2[j];
    jet.rate[j] = b.rate[0] * c1[j] + b.rate[1] * c2[j];
    jet.acceleration[j] = b.acceleration[0] * c1[j] + b.acceleration[1] * c2[j];
  }
}

/// The next: in place, which is safe since the first third is only read where it is written.
void contract_next(std::size_t m, const CoordinateBasis& b, Jet& jet) {
  const double *v1 = jet.value.data() + m, *v2 = jet.value.data() + 2 * m;
  const double *r1 = jet.rate.data() + m, *r2 = jet.rate.data() + 2 * m;
  const double *a1 = jet.acceleration.data() + m, *a2 = jet.acceleration.data() + 2 * m;
  for (std::size_t j = 0; j < m; ++j) {
    jet.acceleration[j] += b.value[0] * a1[j] + b.value[1] * a2[j] + 2.0 * (b.rate[0] * r1[j] + b.rate[1] * r2[j]) +
                           b.acceleration[0] * v1[j] + b.acceleration[1] * v2[j];
    jet.rate[j] += b.value[0] * r1[j] + b.value[1] * r2[j] + b.rate[0] * v1[j] + b.rate[1] * v2[j];
    jet.value[j] += b.value[0] * v1[j] + b.value[1] * v2[j];
  }
}

}  // namespace

std::optional<ProductForm> ProductForm::of(std::span<const std::uint32_t> variables, std::span<const Variable> all,
                                           double length,
                                           const std::function<double(std::span<const double>)>& function) {
  const std::size_t n = variables.size();
  if (n == 0 || n > most_variables) return std::nullopt;
  for (const std::uint32_t v : variables) {
    if (all[v].kind == VariableKind::ball) return std::nullopt;
  }
  ProductForm form;
  form.coefficients_.resize(power(n));
  std::vector<double> at(n);
  const auto kind = [&](std::size_t i) { return all[variables[i]].kind; };
  for (std::size_t k = 0; k < form.coefficients_.size(); ++k) {
    for (std::size_t i = 0, rest = k; i < n; ++i, rest /= 3) at[n - 1 - i] = sample(kind(n - 1 - i), length, rest % 3);
    form.coefficients_[k] = function(at);
  }
  // One variable after another, from values to coefficients.
  for (std::size_t i = 0, stride = 1; i < n; ++i, stride *= 3) {
    for (std::size_t k = 0; k < form.coefficients_.size(); ++k) {
      if (k / stride % 3 != 0) continue;
      double* c = form.coefficients_.data() + k;
      const auto three = from_samples(kind(n - 1 - i), length, {c[0], c[stride], c[2 * stride]});
      for (std::size_t j = 0; j < 3; ++j) c[j * stride] = three[j];
    }
  }
  for (const double c : form.coefficients_) form.size_ += std::abs(c);
  // What is nothing but rounding is nothing.
  for (double& c : form.coefficients_) {
    if (std::abs(c) <= 4.0 * std::numeric_limits<double>::epsilon() * form.size_) c = 0.0;
  }
  // A function of higher order does not agree between the sample points. For now its variables are those alone.
  std::vector<CoordinateBasis> bases(n);
  form.variables_.resize(n);
  std::iota(form.variables_.begin(), form.variables_.end(), 0u);
  for (std::size_t i = 0; i < n; ++i) {
    at[i] = kind(i) == VariableKind::turn ? 1.0 + 0.1 * static_cast<double>(i) : 0.6 * length;
    if (kind(i) == VariableKind::turn) {
      bases[i].set_turn(std::cos(at[i]), std::sin(at[i]));
    } else {
      bases[i].set_slide(at[i]);
    }
  }
  constexpr double roundings = 1e-12;  // many: half a millionth of what a higher order would leave
  if (std::abs(form.value(bases)[0] - function(at)) > roundings * (form.size_ + 1.0)) return std::nullopt;
  form.variables_.assign(variables.begin(), variables.end());
  return form;
}

LastVariable ProductForm::last(std::span<const CoordinateBasis> bases) const {
  const std::size_t n = variables_.size();
  LastVariable result;
  if (n == 1) {
    std::copy(coefficients_.begin(), coefficients_.end(), result.value.begin());
    return result;
  }
  Jet jet;
  std::size_t m = coefficients_.size() / 3;
  contract_first(coefficients_.data(), m, bases[variables_[0]], jet);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    m /= 3;
    contract_next(m, bases[variables_[i]], jet);
  }
  for (std::size_t j = 0; j < 3; ++j) {
    result.value[j] = jet.value[j];
    result.rate[j] = jet.rate[j];
    result.acceleration[j] = jet.acceleration[j];
  }
  return result;
}

std::array<double, 3> ProductForm::value(std::span<const CoordinateBasis> bases) const {
  const LastVariable form = last(bases);
  const CoordinateBasis& b = bases[variables_.back()];
  std::array<double, 3> result{form.value[0], form.rate[0], form.acceleration[0]};
  for (std::size_t i = 0; i < 2; ++i) {
    result[0] += form.value[i + 1] * b.value[i];
    result[1] += form.rate[i + 1] * b.value[i] + form.value[i + 1] * b.rate[i];
    result[2] += form.acceleration[i + 1] * b.value[i] + 2.0 * form.rate[i + 1] * b.rate[i] +
                 form.value[i + 1] * b.acceleration[i];
  }
  return result;
}

double ProductForm::by(std::size_t which, std::span<const CoordinateBasis> bases) const {
  std::array<double, largest> work;
  std::copy(coefficients_.begin(), coefficients_.end(), work.begin());
  std::size_t m = coefficients_.size();
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    m /= 3;
    const CoordinateBasis& b = bases[variables_[i]];
    const bool this_one = i == which;
    const std::array<double, 2>& f = this_one ? b.slope : b.value;
    for (std::size_t j = 0; j < m; ++j) {
      work[j] = (this_one ? 0.0 : work[j]) + f[0] * work[m + j] + f[1] * work[2 * m + j];
    }
  }
  return work[0];
}

}  // namespace koppel
