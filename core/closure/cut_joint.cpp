#include "closure/cut_joint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "spatial/vector.hpp"

namespace koppel {
namespace {

const double tolerance = std::sqrt(std::numeric_limits<double>::epsilon());
constexpr std::size_t largest_run = 3;

/// Whether a sine, or a distance over the length, counts as nothing; doubtful if it is more than rounding all the same.
bool nothing(double x, bool& doubtful) {
  constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
  if (x > tolerance) return false;
  doubtful = doubtful || x > rounding;
  return true;
}

/// A run of motions where all coordinates are zero, seen from the frame before it.
struct Run {
  std::array<VariableKind, largest_run> kinds{};
  std::array<Vector3, largest_run> axes, points;
  std::size_t count = 0;
  Pose end;                       ///< of the frame after the last motion
  mutable bool doubtful = false;  ///< something of it is nothing only to half the digits

  bool all(VariableKind kind) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (kinds[i] != kind) return false;
    }
    return true;
  }
  bool has_ball() const {
    for (std::size_t i = 0; i < count; ++i) {
      if (kinds[i] == VariableKind::ball) return true;
    }
    return false;
  }
  std::size_t turns() const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < count; ++i) n += kinds[i] == VariableKind::turn ? 1 : 0;
    return n;
  }
  std::size_t first_turn() const {
    std::size_t i = 0;
    while (kinds[i] != VariableKind::turn) ++i;
    return i;
  }
};

Run run_of(const Loop& loop, std::span<const Variable> variables, std::size_t first, std::size_t count) {
  Run run;
  run.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    const LoopMotion& motion = loop.motions[(first + i) % loop.motions.size()];
    run.end = run.end * motion.to;
    run.kinds[i] = variables[motion.variable].kind;
    run.axes[i] = run.end.rotation.col(2);
    run.points[i] = run.end.position;
  }
  return run;
}

bool parallel(const Run& run, const Vector3& a, const Vector3& b) { return nothing(a.cross(b).norm(), run.doubtful); }

/// The point in which two axes cross; nothing if they are parallel or pass each other.
std::optional<Vector3> crossing(const Run& run, std::size_t i, std::size_t j, double length) {
  const Vector3 &u = run.axes[i], &w = run.axes[j];
  const Vector3 normal = u.cross(w), apart = run.points[j] - run.points[i];
  const double sine = normal.norm();
  if (nothing(sine, run.doubtful) || !nothing(std::abs(apart.dot(normal)) / (sine * length), run.doubtful)) {
    return std::nullopt;
  }
  return run.points[i] + apart.cross(w).dot(normal) / (sine * sine) * u;
}

/// Turns whose axes all pass through one point; neighbours not parallel.
std::optional<Vector3> common_point(const Run& run, double length) {
  auto point = crossing(run, 0, 1, length);
  if (!point || run.count == 2) return point;
  if (parallel(run, run.axes[1], run.axes[2])) return std::nullopt;
  if (!nothing(run.axes[2].cross(*point - run.points[2]).norm() / length, run.doubtful)) return std::nullopt;
  return point;
}

/// The normal of the plane in which a run of turns and slides moves; zero if it does not.
Vector3 plane_normal(const Run& run) {
  Vector3 normal = Vector3::Zero();
  if (run.turns() > 0) {
    normal = run.axes[run.first_turn()];
  } else if (!parallel(run, run.axes[0], run.axes[1])) {
    normal = run.axes[0].cross(run.axes[1]).normalized();
  }
  for (std::size_t i = 0; i < run.count; ++i) {
    const bool fits = run.kinds[i] == VariableKind::turn ? parallel(run, run.axes[i], normal)
                                                         : nothing(std::abs(run.axes[i].dot(normal)), run.doubtful);
    if (!fits) return Vector3::Zero();
  }
  return normal;
}

/// Whether a planar run has as many freedoms as motions: not two parallel slides, not two equal axes.
bool full_plane(const Run& run, double length) {
  for (std::size_t i = 0; i + 1 < run.count; ++i) {
    const bool slides = run.kinds[i] == VariableKind::slide && run.kinds[i + 1] == VariableKind::slide;
    if (slides && parallel(run, run.axes[i], run.axes[i + 1])) return false;
    const bool turns = run.kinds[i] == VariableKind::turn && run.kinds[i + 1] == VariableKind::turn;
    const Vector3 apart = run.points[i + 1] - run.points[i];
    if (turns && nothing(run.axes[i].cross(apart).norm() / length, run.doubtful)) return false;
  }
  return run.count == 2 || run.turns() > 0;
}

Pose frame(const Vector3& z, const Vector3& origin) {
  Pose result;
  const auto across = tangents<double>(z);
  result.rotation << across.col(0), across.col(1), z;
  result.position = origin;
  return result;
}

/// A joint whose two frames, in the run's zero position, lie at one place, `before`.
CutJoint made(CutShape shape, int freedoms, const Run& run, const Pose& before) {
  return {shape, 0, run.count, freedoms, before, relative_pose(run.end, before)};
}

std::optional<CutJoint> of_one(const Run& run) {
  switch (run.kinds[0]) {
    case VariableKind::turn: return made(CutShape::turn, 1, run, run.end);
    case VariableKind::slide: return made(CutShape::slide, 1, run, run.end);
    case VariableKind::ball: return made(CutShape::ball, 3, run, run.end);
  }
  return std::nullopt;
}

std::optional<CutJoint> of_cylinder(const Run& run) {
  if (run.turns() != 1 || !parallel(run, run.axes[0], run.axes[1])) return std::nullopt;
  const std::size_t turn = run.first_turn();
  return made(CutShape::cylinder, 2, run, frame(run.axes[turn], run.points[turn]));
}

}  // namespace

std::optional<CutJoint> cut_joint(const Loop& loop, std::span<const Variable> variables, std::size_t first,
                                  std::size_t count, double length, bool* doubtful) {
  if (count == 0 || count > std::min(largest_run, loop.motions.size())) return std::nullopt;
  const Run run = run_of(loop, variables, first, count);
  std::optional<CutJoint> found;
  if (count == 1) {
    found = of_one(run);
  } else if (!run.has_ball()) {
    if (run.all(VariableKind::turn)) {
      if (const auto point = common_point(run, length)) {
        found = made(count == 2 ? CutShape::cross : CutShape::ball, static_cast<int>(count), run,
                     frame(run.axes[0], *point));
      }
    }
    if (!found && count == 2) found = of_cylinder(run);
    const Vector3 normal = found ? Vector3::Zero() : plane_normal(run);
    if (!normal.isZero() && full_plane(run, length)) {
      const CutShape shape = count == 3         ? CutShape::plane
                             : run.turns() == 0 ? CutShape::sliding_plane
                                                : CutShape::turning_plane;
      found = made(shape, static_cast<int>(count), run, frame(normal, run.points[0]));
    }
  }
  if (found) found->first = first;
  if (doubtful != nullptr) *doubtful = *doubtful || run.doubtful;
  return found;
}

}  // namespace koppel
