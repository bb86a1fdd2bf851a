#include "problems.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

#include <Eigen/Eigenvalues>

#include "matrix_numbers.hpp"
#include "operations.hpp"

namespace koppel::bench {
namespace {

using Real = long double;  // of the right results
using Column = Eigen::VectorX<Real>;

constexpr Real pi = std::numbers::pi_v<Real>;

/// Inputs of any type, out of the i-th rotation and those after it.
class Source {
 public:
  Source(const Rotations& rotations, std::size_t i) : rotations_(rotations), i_(i) {}

  template <typename C>
  Eigen::Matrix<Real, C::size, 1> coordinates() {
    return C::template of_quaternion<Real>(next()).coordinates;
  }

  template <typename Type>
  Type make() {
    Type value;
    make(value);
    return value;
  }

 private:
  void make(Matrix3T<Real>& r) { r = rotation_of_quaternion<Real>(next()); }
  void make(Vector4T<Real>& q) { q = next(); }
  void make(Vector3T<Real>& v) { v = rotation_vector_of_quaternion<Real>(next()); }
  void make(Vector6T<Real>& x) { x = make<TwistT<Real>>().vector(); }
  void make(TwistT<Real>& t) {
    make(t.angular);
    make(t.linear);
  }
  void make(PoseT<Real>& x) {
    make(x.rotation);
    make(x.position);
  }
  /// Of a pose: the dual part is half the position times the rotation.
  void make(Vector4T<Dual<Real>>& q) {
    const Vector4T<Real> rotation = next();
    Vector4T<Real> position = next();
    position[0] = 0;
    q = dual(rotation, quaternion_product<Real>(position, rotation) / 2);
  }

  /// The first is that of the list; from it to the second it is that of the list again.
  Vector4T<Real> next() {
    const Vector4T<Real>& q = rotations_[i_++ % rotations_.size()];
    return last_ = quaternion_product<Real>(last_, q);
  }

  const Rotations& rotations_;
  std::size_t i_;
  Vector4T<Real> last_ = Vector4T<Real>::Unit(0);
};

template <typename Type>
Column column(const Type& value) {
  Column numbers(static_cast<Eigen::Index>(Numbers<Type>::size));
  Numbers<Type>::write(value, numbers.data());
  return numbers;
}

/// What a kind of coordinates tells about conversions from and to it.
struct Chart {
  std::vector<Column> (*twins)(const Column& x);  ///< the other coordinates of the same rotation, if there are any
  Eigen::MatrixXd (*h_matrix)(const Column& x);
  Eigen::MatrixXd (*k_matrix)(const Column& x);  ///< without entries where it does not exist
  Eigen::Index angles = 0;                       ///< so many of the last coordinates are angles
};

template <typename C>
constexpr Eigen::Index angles_of = 0;
template <>
constexpr Eigen::Index angles_of<AxisAngle> = 1;
template <int i, int j, int k>
constexpr Eigen::Index angles_of<AngleSequence<i, j, k>> = 3;

template <typename C>
Chart chart() {
  using Coordinates = Eigen::Matrix<Real, C::size, 1>;
  const auto twins = [](const Column& x) -> std::vector<Column> {
    if constexpr (std::is_same_v<C, RotationVector>) {
      const auto twin = C::template twin<Real>(x);
      if (twin) return {*twin};
    } else if constexpr (requires(Coordinates y) { C::template twin<Real>(y); }) {
      return {C::template twin<Real>(x)};
    }
    return {};
  };
  const auto h_matrix = [](const Column& x) -> Eigen::MatrixXd {
    return C::template h_matrix<double>(x.template cast<double>(), Axes::base);
  };
  const auto k_matrix = [](const Column& x) {
    const auto k = C::template k_matrix<double>(x.template cast<double>(), Axes::base);
    return k ? Eigen::MatrixXd(*k) : Eigen::MatrixXd();
  };
  return {twins, h_matrix, k_matrix, angles_of<C>};
}

/// How much an error in coordinates x grows on the way to coordinates y of another kind: by |K H| |x| / |y|, or
/// |K H| |x| where y is short, as errors are absolute there.
double condition(const Chart& from, const Column& x, const Chart& to, const Column& y) {
  const Eigen::MatrixXd k = to.k_matrix(y);
  if (k.size() == 0) return std::numeric_limits<double>::infinity();
  const double growth = (k * from.h_matrix(x)).operatorNorm();
  return std::max(1.0, growth * static_cast<double>(x.norm() / std::max<Real>(1, y.norm())));
}

/// How the problem of an operation is made.
struct Recipe {
  Column (*input)(Source& source);               ///< its numbers
  Column (*answer)(const double* input);         ///< after these were rounded
  std::optional<std::pair<Chart, Chart>> kinds;  ///< of a conversion: from, to

  Problem operator()(const Rotations& rotations) const;
};

Problem Recipe::operator()(const Rotations& rotations) const {
  Problem problem;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    Source source(rotations, i);
    const Eigen::VectorXd rounded = input(source).cast<double>();
    problem.inputs.insert(problem.inputs.end(), rounded.begin(), rounded.end());
    problem.answers.push_back({answer(rounded.data())});
    problem.conditions.push_back(1);
    if (kinds) {
      const auto& [from, to] = *kinds;
      auto& answers = problem.answers.back();
      for (const Column& twin : to.twins(answers[0])) answers.push_back(twin);
      problem.conditions.back() = condition(from, rounded.cast<Real>(), to, answers[0]);
      problem.angles = to.angles;
    }
  }
  return problem;
}

/// Makes recipes of operations.
struct Operations {
  template <typename Input, typename From, typename To>
  void add(const std::string& name, Conversion<From, To, Real>) {
    const auto input = [](Source& source) -> Column { return source.coordinates<From>(); };
    list.push_back({name, Recipe{input, answer<Conversion<From, To, Real>, Input>, {{chart<From>(), chart<To>()}}}});
  }

  template <typename... Inputs, typename Function>
  void add(const std::string& name, Function) {
    const auto input = [](Source& source) {
      Column numbers(static_cast<Eigen::Index>(Numbers<std::tuple<Inputs...>>::size));
      Eigen::Index start = 0;
      const auto append = [&](const Column& part) {
        numbers.segment(start, part.size()) = part;
        start += part.size();
      };
      (append(column(source.make<Inputs>())), ...);
      return numbers;
    };
    list.push_back({name, Recipe{input, answer<Function, Inputs...>, {}}});
  }

  template <typename Function, typename... Inputs>
  static Column answer(const double* numbers) {
    return column(std::apply(Function{}, Numbers<std::tuple<Inputs...>>::read(numbers)));
  }

  std::vector<Operation> list;
};

Vector4T<Real> turn(int axis, Real angle) {
  Vector4T<Real> q = Vector4T<Real>::Zero();
  q[0] = std::cos(angle / 2);
  q[1 + axis] = std::sin(angle / 2);
  return q;
}

}  // namespace

Rotations random_rotations(std::size_t count) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  Rotations rotations;
  for (std::size_t i = 0; i < count; ++i) {
    Vector4T<Real> q;
    for (Real& number : q) number = normal(engine);
    rotations.push_back(q.normalized());
  }
  return rotations;
}

Rotations special_rotations(std::size_t count) {
  constexpr Real little = 1e-9L;
  Rotations rotations = random_rotations(count);
  for (std::size_t i = 0; i < count; ++i) {
    Vector4T<Real>& q = rotations[i];
    const Vector3T<Real> axis = q.tail<3>().normalized();
    const auto between = [&q](int first, int middle, Real angle, int last) {
      return quaternion_product<Real>(turn(first, 3 * q[1]),
                                      quaternion_product<Real>(turn(middle, angle), turn(last, 3 * q[2])));
    };
    switch (i % 6) {
      case 0: q << std::cos(little / 2), std::sin(little / 2) * axis; break;
      case 1: q << std::sin(little / 2), std::cos(little / 2) * axis; break;
      case 2: q = between(2, 0, little, 2); break;
      case 3: q = between(2, 0, pi - little, 2); break;
      case 4: q = between(0, 1, pi / 2 - little, 2); break;
      default: q = between(2, 1, pi / 2 - little, 0); break;
    }
  }
  return rotations;
}

Errors Problem::errors(const std::vector<double>& results) const {
  const std::size_t count = answers.size();
  const auto size = static_cast<Eigen::Index>(results.size() / count);
  Errors worst;
  for (std::size_t i = 0; i < count; ++i) {
    const Column result =
        Eigen::Map<const Eigen::VectorXd>(results.data() + i * static_cast<std::size_t>(size), size).cast<Real>();
    double least = std::numeric_limits<double>::infinity();
    for (const Column& answer : answers[i]) {
      Column difference = result - answer;
      for (Real& angle : difference.tail(angles)) angle = std::remainder(angle, 2 * pi);
      const Real error = difference.norm() / std::max<Real>(1, answer.norm());
      if (error < least) least = static_cast<double>(error);
    }
    const double units = std::ldexp(least, 53);
    worst.error = std::max(worst.error, units);
    worst.by_condition = std::max(worst.by_condition, units / conditions[i]);
  }
  return worst;
}

std::vector<Operation> operations() {
  Operations operations;
  list_operations<Real>(operations);
  return operations.list;
}

}  // namespace koppel::bench
