// Functions of joint coordinates written out: a closure condition, or an entry of a pose, is a sum of products of the
// basis functions 1, cos, sin of turns and 1, d, d^2 of slides. With the coefficients computed once, a condition of two
// joints costs nine multiplications, and its time derivatives little more.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "closure/loop.hpp"

namespace koppel {

/// The basis functions of one coordinate x: 1, f1, f2, without the 1; their derivatives by x; and both by time.
struct CoordinateBasis {
  std::array<double, 2> value{}, slope{}, rate{}, acceleration{};

  /// Sets value and slope; of a turn by cosine and sine, so that nobody computes them twice.
  void set_turn(double cosine, double sine) {
    value = {cosine, sine};
    slope = {-sine, cosine};
  }
  void set_slide(double d) {
    value = {d, d * d};
    slope = {1.0, 2.0 * d};
  }
  /// Sets the time derivatives, after the values.
  void set_motion(VariableKind kind, double v, double a) {
    for (std::size_t i = 0; i < 2; ++i) rate[i] = slope[i] * v;
    if (kind == VariableKind::turn) {
      for (std::size_t i = 0; i < 2; ++i) acceleration[i] = slope[i] * a - value[i] * v * v;
    } else {
      acceleration = {a, 2.0 * (v * v + value[0] * a)};
    }
  }
};

/// A function as a form in the last of its variables, c0 + c1 f1 + c2 f2, with the time derivatives that the others
/// give the coefficients.
struct LastVariable {
  std::array<double, 3> value{}, rate{}, acceleration{};
};

class ProductForm {
 public:
  static constexpr std::size_t most_variables = 5;

  /// From samples of a function of the coordinates (in the order of `variables`). No form: more variables, a ball, or a
  /// function of higher order (closure type 3). length [m]: how far slides are sampled.
  static std::optional<ProductForm> of(std::span<const std::uint32_t> variables, std::span<const Variable> all,
                                       double length, const std::function<double(std::span<const double>)>& function);

  std::span<const std::uint32_t> variables() const { return variables_; }
  /// Sum of the sizes of all coefficients: what rounding is relative to.
  double size() const { return size_; }

  /// As a form in the last variable. bases: of all variables of the mechanism.
  LastVariable last(std::span<const CoordinateBasis> bases) const;
  /// Value and time derivatives; needs those of all variables.
  std::array<double, 3> value(std::span<const CoordinateBasis> bases) const;
  /// The derivative by the i-th of its variables.
  double by(std::size_t i, std::span<const CoordinateBasis> bases) const;

 private:
  std::vector<std::uint32_t> variables_;
  std::vector<double> coefficients_;  ///< 3^n, the last variable's fastest
  double size_ = 0.0;
};

}  // namespace koppel
