#include "closure/common_roots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "closure/decompositions.hpp"
#include "closure/scalar_roots.hpp"
#include "spatial/rotation_coordinates.hpp"

namespace koppel {

namespace {

using Matrix5 = Eigen::Matrix<double, 5, 5>;
using Vector5 = Eigen::Matrix<double, 5, 1>;
using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;
using Complex = std::complex<double>;
using Kind = Unknown::Kind;
constexpr Eigen::Index max_size = 8;  ///< of Sylvester's matrix
using Sylvester = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_size, max_size>;
using ComplexSylvester = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, 0, max_size, max_size>;

constexpr double touch_floor =
    0.5e-14;                          ///< of the coefficients: what is zero between two equal roots, as in one unknown
constexpr double nearly_real = 1e-2;  ///< distance of an eigenvalue from the real ones up to which it is tried
constexpr double promising = 1e-2;    ///< residual over the coefficients up to which a start is tried
constexpr double at_infinity = 1e-3;  ///< distance from there up to which a root is counted as infinite
constexpr double pi = std::numbers::pi;

/// Polynomials in t with the constant term first; `a` times `b`.
Vector5 times(const Vector5& a, const Vector5& b) {
  Vector5 product = Vector5::Zero();
  for (Eigen::Index i = 0; i < 5; ++i) product.tail(5 - i) += a[i] * b.head(5 - i);
  return product;
}

struct Basis {
  Vector5 value, derivative;
};

Basis basis(Kind kind, double x) {
  Basis b;
  if (kind == Kind::displacement) {
    b.value << 1.0, x, x * x, 0.0, 0.0;
    b.derivative << 0.0, 1.0, 2.0 * x, 0.0, 0.0;
  } else {
    const double c = std::cos(x), s = std::sin(x), cc = (c - s) * (c + s), ss = 2.0 * s * c;
    b.value << 1.0, c, s, cc, ss;
    b.derivative << 0.0, -s, c, -2.0 * ss, 2.0 * cc;
  }
  return b;
}

int order_of(Kind kind, Eigen::Index term) { return static_cast<int>(kind == Kind::angle ? (term + 1) / 2 : term); }

/// A projective coordinate t of an unknown, turned by a given angle so that nothing of interest is at infinity:
/// (p : q) = (cos t + sin : cos - sin t) is tan(x / 2) of an angle, s itself of a displacement.
struct Chart {
  Kind kind;
  double cosine, sine;

  double unknown(double t) const {
    const double p = cosine * t + sine, q = cosine - sine * t;
    return kind == Kind::angle ? wrapped<double>(2.0 * std::atan2(p, q)) : p / q;
  }

  /// Whether t is a displacement without end, or an angle the cosine of which is. Distances are those on a sphere.
  bool is_infinite(const Complex& t) const {
    const double size = std::sqrt(1.0 + std::norm(t));
    const Complex i(0.0, 1.0);
    if (kind == Kind::displacement) return std::abs(cosine - sine * t) < at_infinity * size;
    return std::min(std::abs(t - i), std::abs(t + i)) < at_infinity * size;
  }

  int degree(int order) const { return kind == Kind::angle ? 2 * order : order; }

  /// Row i: basis function i times q^order or (p^2 + q^2)^order, as a polynomial in t.
  Matrix5 polynomials(int order) const {
    Vector5 one = Vector5::Unit(0), p = Vector5::Zero(), q = Vector5::Zero();
    p.head<2>() << sine, cosine;
    q.head<2>() << cosine, -sine;
    Matrix5 rows = Matrix5::Zero();
    if (order == 0) {
      rows.row(0) = one;
    } else if (kind == Kind::displacement) {
      const Vector5 rest = order == 2 ? q : one;
      rows.row(0) = times(q, rest);
      rows.row(1) = times(p, rest);
      if (order == 2) rows.row(2) = times(p, p);
    } else {
      const Vector5 c = times(q, q) - times(p, p), s = 2.0 * times(p, q), n = times(p, p) + times(q, q);
      const Vector5 rest = order == 2 ? n : one;
      rows.row(0) = times(n, rest);
      rows.row(1) = times(c, rest);
      rows.row(2) = times(s, rest);
      if (order == 2) rows.row(3) = times(c, c) - times(s, s), rows.row(4) = 2.0 * times(c, s);
    }
    return rows;
  }
};

/// A condition with displacements in their lengths, its largest coefficient 1, and rounding set to zero.
struct Normal {
  Matrix5 c = Matrix5::Zero();
  int order_x = 0, order_y = 0;
  double touch = touch_floor;
  bool zero = true;

  Normal() = default;
  Normal(const Unknown& x, const Unknown& y, const Condition2& condition, double scale) {
    const auto unit = [](const Unknown& u, Eigen::Index i) {
      return u.kind == Kind::angle ? 1.0 : std::pow(u.length, static_cast<double>(i));
    };
    for (Eigen::Index i = 0; i < x.terms(); ++i) {
      for (Eigen::Index j = 0; j < y.terms(); ++j) c(i, j) = condition.c(i, j) * unit(x, i) * unit(y, j);
    }
    const double size = c.cwiseAbs().maxCoeff();
    zero = !(size > 1e-12 * scale) || !c.allFinite();
    if (zero) return;
    c /= size;
    const double noise = rounding_floor<double>() * std::max(1.0, scale / size);
    touch = std::max(touch_floor, 4.0 * noise);
    for (Eigen::Index i = 0; i < 5; ++i) {
      for (Eigen::Index j = 0; j < 5; ++j) {
        if (std::abs(c(i, j)) <= noise) {
          c(i, j) = 0.0;
        } else {
          order_x = std::max(order_x, order_of(x.kind, i));
          order_y = std::max(order_y, order_of(y.kind, j));
        }
      }
    }
  }

  Normal swapped() const {
    Normal n = *this;
    n.c.transposeInPlace();
    std::swap(n.order_x, n.order_y);
    return n;
  }

  /// Roots in y at a given x; where it just misses zero, the place where it does.
  Roots section(Kind kind_y, const Vector5& at_x) const {
    const Vector5 r = c.transpose() * at_x;
    Roots found;
    if (kind_y == Kind::displacement) {
      found = roots(Quadratic{r[0], r[1], r[2]}, 1.0);
    } else if (order_y <= 1) {
      found = roots(FirstHarmonic{r[0], r[1], r[2]}, 1.0);
    } else {
      found = roots(SecondHarmonic{r[0], r[1], r[2], r[3], r[4]}, 1.0);
    }
    if (found.count == 0 && found.missed_by < promising) found.values[found.count++] = found.nearest;
    return found;
  }
};

/// Both conditions at one point.
struct At {
  Vector2 f;
  Matrix2 jacobian;
  double terms;  ///< size of the larger sum of terms, at least 1

  double off() const { return f.norm() / terms; }
};

/// The search for common roots: the unknowns in units of their lengths.
class Search {
 public:
  Search(Kind kind_x, Kind kind_y, Normal f, Normal g)
      : x_(kind_x), y_(kind_y), f_(std::move(f)), g_(std::move(g)), touch_(std::max(f_.touch, g_.touch)) {}

  CommonRoots run() {
    if (f_.order_y == 0) {
      split(f_, g_);
    } else if (g_.order_y == 0) {
      split(g_, f_);
    } else {
      eliminate();
    }
    return std::move(result_);
  }

 private:
  At at(const Vector2& p) const {
    const Basis bx = basis(x_, p[0]), by = basis(y_, p[1]);
    const Vector5 f = f_.c * by.value, g = g_.c * by.value;
    At a;
    a.f << bx.value.dot(f), bx.value.dot(g);
    a.jacobian << bx.derivative.dot(f), bx.value.dot(f_.c * by.derivative), bx.derivative.dot(g),
        bx.value.dot(g_.c * by.derivative);
    const Vector5 size_x = bx.value.cwiseAbs(), size_y = by.value.cwiseAbs();
    a.terms = std::max(1.0, size_x.maxCoeff() * size_y.maxCoeff());
    return a;
  }

  /// What F may be wrong by at p.
  double rounding(const Vector2& p) const {
    const Vector5 size_x = basis(x_, p[0]).value.cwiseAbs(), size_y = basis(y_, p[1]).value.cwiseAbs();
    const double largest = std::max(size_x.dot(f_.c.cwiseAbs() * size_y), size_x.dot(g_.c.cwiseAbs() * size_y));
    return epsilon<double>() * touch_ / touch_floor * largest;
  }

  /// p with its angles in (-pi, pi].
  Vector2 normal(const Vector2& p) const {
    return {x_ == Kind::angle ? wrapped<double>(p[0]) : p[0], y_ == Kind::angle ? wrapped<double>(p[1]) : p[1]};
  }

  Vector2 apart(const Vector2& a, const Vector2& b) const {
    const auto component = [](Kind kind, double d) { return kind == Kind::angle ? std::remainder(d, 2.0 * pi) : d; };
    return {component(x_, a[0] - b[0]), component(y_, a[1] - b[1])};
  }

  /// Newton's method, with half steps where a whole one does not help; until nothing helps.
  Vector2 polished(Vector2 p) const {
    At here = at(p);
    for (int i = 0; i < 30 && here.f.cwiseAbs().maxCoeff() > 0.0; ++i) {
      const double d = here.jacobian.determinant();
      Vector2 step(here.jacobian(0, 1) * here.f[1] - here.jacobian(1, 1) * here.f[0],
                   here.jacobian(1, 0) * here.f[0] - here.jacobian(0, 0) * here.f[1]);
      step /= d;
      bool better = false;
      for (int k = 0; k < 4 && !better && step.allFinite(); ++k, step *= 0.5) {
        const At next = at(p + step);
        better = next.f.squaredNorm() < here.f.squaredNorm();
        if (better) p += step, here = next;
      }
      if (!better) break;
    }
    return p;
  }

  struct Weakest {
    double strong, value;  ///< the singular values of the Jacobian
    Vector2 strong_left, strong_right, left, right;
    double curvature;  ///< left' F'' (right, right)
  };
  Weakest weakest(const Vector2& p, const At& a) const {
    const Eigen::JacobiSVD<Matrix2> svd(a.jacobian, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Weakest w{svd.singularValues()[0],
              svd.singularValues()[1],
              svd.matrixU().col(0),
              svd.matrixV().col(0),
              svd.matrixU().col(1),
              svd.matrixV().col(1),
              0.0};
    constexpr double step = 1e-4;
    const Matrix2 change = at(p + step * w.right).jacobian - at(p - step * w.right).jacobian;
    w.curvature = w.left.dot(change * w.right) / (2.0 * step);
    return w;
  }

  /// p moved to where only the weak combination of the conditions is not zero: into the valley between two roots, which
  /// is curved.
  Vector2 in_valley(const Vector2& p) const {
    const At a = at(p);
    const Weakest w = weakest(p, a);
    return p - w.strong_left.dot(a.f) / w.strong * w.strong_right;
  }

  /// At a double root, Newton's method stops anywhere where F is rounding: from there to where det J = 0.
  Vector2 centred(Vector2 p) const {
    for (int i = 0; i < 2; ++i) {
      const Weakest w = weakest(p, at(p));
      const double along = w.value / w.curvature;
      if (!(std::abs(along) < 1e-4)) break;
      const Vector2 next = in_valley(p - along * w.right);
      if (!(at(next).off() <= touch_)) break;
      p = next;
    }
    return p;
  }

  bool is_known(const Vector2& p) const {
    for (const CommonRoot& r : result_.roots) {
      const Vector2 q(r.x, r.y), d = apart(p, q), middle = q + 0.5 * d;
      if (d.norm() > 1e-2 * (1.0 + q.norm())) continue;
      // One root and not two, if F is rounding in between as well.
      if (at(middle).off() <= touch_ || at(in_valley(middle)).off() <= touch_) return true;
    }
    return false;
  }

  void start(const Vector2& from, bool look_for_twin = true) {
    if (!(at(from).off() <= promising)) return;
    Vector2 p = polished(from);
    At a = at(p);
    if (!(a.off() <= touch_) || is_known(p)) return;
    const Weakest w = weakest(p, a);
    const double bend = std::abs(w.curvature), tolerance = touch_ * a.terms;
    const bool repeated = w.value * w.value <= 2.0 * tolerance * bend;
    // A line x = const is a factor of the resultant and no reason for it to vanish.
    const auto is_line = [&](double y) { return at({p[0], p[1] + y}).off() <= touch_; };
    if (repeated && is_line(0.5) && is_line(-0.7) && is_line(1.1)) result_.degenerate = true;
    if (result_.degenerate) return;
    if (repeated) p = centred(p);
    const double noise = rounding(p);
    const double error = (repeated ? std::sqrt(2.0 * noise / bend) : noise / w.value) + epsilon<double>() * p.norm();
    p = normal(p);
    result_.roots.push_back({p[0], p[1], repeated, error});
    // A second root nearby, along the weak direction, may have had the same eigenvalue.
    if (look_for_twin && !repeated && w.value < 1e-2 * bend) start(p - 2.0 * w.value / w.curvature * w.right, false);
  }

  /// All roots with a given x.
  void lift(double x) {
    const Vector5 at_x = basis(x_, x).value;
    if (!at_x.allFinite()) return;
    const Roots a = f_.section(y_, at_x), b = g_.section(y_, at_x);
    const bool a_all = a.everywhere || f_.order_y == 0, b_all = b.everywhere || g_.order_y == 0;
    if (a_all && b_all) {
      if (at({x, 0.0}).off() <= touch_) result_.degenerate = true;
      return;
    }
    for (int i = 0; !a_all && i < a.count; ++i) start({x, a.values[static_cast<std::size_t>(i)]});
    for (int i = 0; !b_all && i < b.count; ++i) start({x, b.values[static_cast<std::size_t>(i)]});
  }

  /// `first` depends on x alone.
  void split(const Normal& first, const Normal& second) {
    const Normal across = first.swapped();
    const Roots xs = across.section(x_, Vector5::Unit(0));
    for (int i = 0; i < xs.count; ++i) lift(xs.values[static_cast<std::size_t>(i)]);
    const Chart chart_x{x_, 1.0, 0.0}, chart_y{y_, 1.0, 0.0};
    if (!result_.degenerate) {
      result_.complex_count = chart_x.degree(first.order_x) * chart_y.degree(second.order_y);
    }
  }

  struct Pencil {
    std::array<Sylvester, 5> s;  ///< coefficients of 1, t, t^2 ... of x
    int degree = 0;              ///< in t
    int added = 0;               ///< how often t = 0 was made a root to raise a condition of lower degree
    double pivots = 0.0;         ///< of the leading matrix: smallest over largest
  };
  Pencil pencil(const Chart& cx, const Chart& cy) const {
    const int mf = cx.degree(f_.order_x), mg = cx.degree(g_.order_x);
    const int nf = cy.degree(f_.order_y), ng = cy.degree(g_.order_y);
    const Matrix5 pf = cx.polynomials(f_.order_x).transpose() * f_.c * cy.polynomials(f_.order_y);
    const Matrix5 pg = cx.polynomials(g_.order_x).transpose() * g_.c * cy.polynomials(g_.order_y);
    Pencil p;
    p.degree = std::max(mf, mg);
    p.added = (p.degree - mf) * ng + (p.degree - mg) * nf;
    for (Sylvester& s : p.s) s = Sylvester::Zero(nf + ng, nf + ng);
    const auto fill = [&](const Matrix5& c, int m, int n, int first, int count) {
      for (int row = 0; row < count; ++row) {
        for (int k = 0; k <= m; ++k) {
          p.s[static_cast<std::size_t>(k + p.degree - m)].row(first + row).segment(row, n + 1) = c.row(k).head(n + 1);
        }
      }
    };
    fill(pf, mf, nf, 0, ng);
    fill(pg, mg, ng, ng, nf);
    const Eigen::FullPivLU<Sylvester> lu(p.s[static_cast<std::size_t>(p.degree)]);
    const double last = std::abs(lu.matrixLU()(nf + ng - 1, nf + ng - 1));
    p.pivots = lu.maxPivot() > 0.0 ? last / lu.maxPivot() : 0.0;
    return p;
  }

  void eliminate() {
    // Any turn that is not special will do; the best conditioned of a few.
    const Chart cy{y_, std::cos(0.7393), std::sin(0.7393)};
    Chart best{x_, 1.0, 0.0};
    Pencil p;
    for (const double turn : {0.3217, 1.1094, 1.9021, 2.6873}) {
      const Chart chart{x_, std::cos(turn), std::sin(turn)};
      const Pencil candidate = pencil(chart, cy);
      if (candidate.pivots > p.pivots) p = candidate, best = chart;
    }
    if (!(p.pivots > 16.0 * touch_)) {
      result_.degenerate = true;
      return;
    }
    const Eigen::Index n = p.s[0].rows(), size = n * p.degree;
    Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(size, size);
    companion.topRightCorner(size - n, size - n).setIdentity();
    const Eigen::PartialPivLU<Sylvester> lead(p.s[static_cast<std::size_t>(p.degree)]);
    for (int k = 0; k < p.degree; ++k) {
      companion.block(size - n, k * n, n, n) = -lead.solve(p.s[static_cast<std::size_t>(k)]);
    }
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(companion, false);
    std::vector<Complex> t(solver.eigenvalues().begin(), solver.eigenvalues().end());
    for (const Complex& value : t) {
      if (std::abs(value.imag()) <= nearly_real * (1.0 + std::norm(value))) lift(best.unknown(value.real()));
    }
    if (result_.degenerate) return;
    result_.complex_count = std::max(finite_count(p, best, cy, t), static_cast<int>(result_.roots.size()));
  }

  static int finite_count(const Pencil& p, const Chart& cx, const Chart& cy, std::vector<Complex>& t) {
    std::sort(t.begin(), t.end(), [](const Complex& a, const Complex& b) { return std::norm(a) < std::norm(b); });
    int count = 0;
    for (auto value = t.begin() + p.added; value != t.end(); ++value) {
      if (cx.is_infinite(*value) || value->imag() < 0.0) continue;
      const Eigen::Index n = p.s[0].rows();
      ComplexSylvester s = ComplexSylvester::Zero(n, n);
      for (int k = p.degree; k >= 0; --k) s = s * *value + p.s[static_cast<std::size_t>(k)].cast<Complex>();
      // The null vector is (1, t_y, t_y^2 ...).
      const Eigen::PartialPivLU<ComplexSylvester> lu(s);
      Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, max_size, 1> v = ComplexSylvester::Ones(n, 1);
      for (int i = 0; i < 2; ++i) v = lu.solve(v).normalized();
      const Complex ty = std::abs(v[0]) > std::abs(v[n - 1]) ? v[1] / v[0] : v[n - 1] / v[n - 2];
      if (!cy.is_infinite(ty)) count += value->imag() > 0.0 ? 2 : 1;
    }
    return count;
  }

  Kind x_, y_;
  Normal f_, g_;
  double touch_;
  CommonRoots result_;
};

/// Coefficients in the basis of an unknown from values at its sample points.
Vector5 from_values(const Unknown& u, const Vector5& v) {
  Vector5 c = Vector5::Zero();
  if (u.kind == Kind::angle && u.order == 1) {
    const auto f = FirstHarmonic::from_samples({v[0], v[1], v[2]});
    c << f.c0, f.c1, f.s1, 0.0, 0.0;
  } else if (u.kind == Kind::angle) {
    const auto f = SecondHarmonic::from_samples({v[0], v[1], v[2], v[3], v[4]});
    c << f.c0, f.c1, f.s1, f.c2, f.s2;
  } else if (u.order == 1) {
    c.head<2>() << 0.5 * (v[0] + v[1]), 0.5 * (v[1] - v[0]) / u.length;
  } else {
    const auto f = Quadratic::from_samples({v[0], v[1], v[2]}, u.length);
    c.head<3>() << f.c0, f.c1, f.c2;
  }
  return c;
}

}  // namespace

int Unknown::terms() const { return kind == Kind::angle ? 2 * order + 1 : order + 1; }

double Unknown::sample(int i) const {
  const auto k = static_cast<std::size_t>(i);
  if (kind == Kind::angle) return order == 1 ? FirstHarmonic::samples[k] : SecondHarmonic::samples[k];
  return length * (order == 1 ? 2.0 * i - 1.0 : Quadratic::samples[k]);
}

Condition2 Condition2::from_samples(const Unknown& x, const Unknown& y, const Matrix5& values) {
  Condition2 condition;
  Matrix5 half = Matrix5::Zero();
  for (Eigen::Index j = 0; j < y.terms(); ++j) half.col(j) = from_values(x, values.col(j));
  for (Eigen::Index i = 0; i < x.terms(); ++i) condition.c.row(i) = from_values(y, half.row(i).transpose()).transpose();
  return condition;
}

double Condition2::value(const Unknown& x, const Unknown& y, double at_x, double at_y) const {
  return basis(x.kind, at_x).value.dot(c * basis(y.kind, at_y).value);
}

CommonRoots common_roots(const Unknown& x, const Unknown& y, const Condition2& f, const Condition2& g, double scale) {
  const Normal a(x, y, f, scale), b(x, y, g, scale);
  CommonRoots result;
  if (a.zero || b.zero) {
    result.degenerate = true;
    return result;
  }
  // The unknown that is eliminated is the one that leaves the smaller eigenvalue problem; one that a condition does
  // without, if there is one.
  const auto swapped_a = a.swapped(), swapped_b = b.swapped();
  const auto size = [](Kind kind_x, Kind kind_y, const Normal& p, const Normal& q) {
    const Chart cx{kind_x, 1.0, 0.0}, cy{kind_y, 1.0, 0.0};
    return (cy.degree(p.order_y) + cy.degree(q.order_y)) * cx.degree(std::max(p.order_x, q.order_x));
  };
  const int without_y = size(x.kind, y.kind, a, b), without_x = size(y.kind, x.kind, swapped_a, swapped_b);
  const bool split_y = a.order_y == 0 || b.order_y == 0, split_x = a.order_x == 0 || b.order_x == 0;
  const bool swap = !split_y && (split_x || without_x < without_y);
  result = swap ? Search(y.kind, x.kind, swapped_a, swapped_b).run() : Search(x.kind, y.kind, a, b).run();
  const double length_x = x.kind == Kind::angle ? 1.0 : x.length, length_y = y.kind == Kind::angle ? 1.0 : y.length;
  for (CommonRoot& r : result.roots) {
    if (swap) std::swap(r.x, r.y);
    r.x *= length_x;
    r.y *= length_y;
    r.error *= std::max(length_x, length_y);
  }
  std::sort(result.roots.begin(), result.roots.end(),
            [](const CommonRoot& p, const CommonRoot& q) { return p.x != q.x ? p.x < q.x : p.y < q.y; });
  return result;
}

}  // namespace koppel
