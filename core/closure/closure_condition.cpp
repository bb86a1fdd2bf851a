#include "closure/closure_condition.hpp"

#include <array>

namespace koppel {
namespace {

using enum ClosureType;

constexpr std::uint8_t x = 0, y = 1, z = 2;

/// In all of them joint a is the one with more freedoms.
constexpr std::array one_distance{ClosureCondition{point_point}};
constexpr std::array point_of_b_in_plane_of_a{ClosureCondition{point_plane, z, z, true}};
constexpr std::array point_of_a_in_plane_of_b{ClosureCondition{point_plane, z, z, false}};
constexpr std::array one_angle{ClosureCondition{angle, z, z}};
constexpr std::array point_of_a_line_of_b{ClosureCondition{point_line, z, z, false}};
constexpr std::array two_lines{ClosureCondition{angle, z, z}, ClosureCondition{line_line}};
constexpr std::array ball_turn{ClosureCondition{point_point}, ClosureCondition{point_plane, z, z, false}};
constexpr std::array plane_turn{ClosureCondition{point_plane, z, z, true}, ClosureCondition{angle, z, z}};
constexpr std::array cylinder_turn{ClosureCondition{point_line, z, z, true}, ClosureCondition{angle, z, z},
                                   ClosureCondition{line_line}};
constexpr std::array turn_turn{ClosureCondition{point_point}, ClosureCondition{point_plane, z, z, true},
                               ClosureCondition{point_plane, z, z, false}, ClosureCondition{angle, z, z}};
constexpr std::array ball_slide{ClosureCondition{point_plane, z, x, false}, ClosureCondition{point_plane, z, y, false}};
constexpr std::array plane_slide{ClosureCondition{angle, z, x}, ClosureCondition{angle, z, y}};
constexpr std::array cylinder_slide{ClosureCondition{angle, z, x}, ClosureCondition{angle, z, y},
                                    ClosureCondition{line_line}};
constexpr std::array turn_slide{ClosureCondition{point_plane, z, x, false}, ClosureCondition{point_plane, z, y, false},
                                ClosureCondition{angle, z, x}, ClosureCondition{angle, z, y}};
constexpr std::array slide_slide{ClosureCondition{angle, x, x}, ClosureCondition{angle, y, y},
                                 ClosureCondition{angle, z, z}, ClosureCondition{line_line}};

constexpr std::array of_ball{ClosureCondition{point_plane, z, x, false}, ClosureCondition{point_plane, z, y, false},
                             ClosureCondition{point_plane, z, z, false}};
constexpr std::array of_plane{ClosureCondition{point_plane, z, z, false}, ClosureCondition{angle, z, x},
                              ClosureCondition{angle, z, y}};
constexpr std::array of_cylinder{ClosureCondition{point_plane, z, x, false}, ClosureCondition{point_plane, z, y, false},
                                 ClosureCondition{angle, z, x}, ClosureCondition{angle, z, y}};
constexpr std::array of_turn{ClosureCondition{point_plane, z, x, false}, ClosureCondition{point_plane, z, y, false},
                             ClosureCondition{point_plane, z, z, false}, ClosureCondition{angle, z, x},
                             ClosureCondition{angle, z, y}};
constexpr std::array of_slide{ClosureCondition{point_plane, z, x, false}, ClosureCondition{point_plane, z, y, false},
                              ClosureCondition{angle, z, x}, ClosureCondition{angle, z, y},
                              ClosureCondition{angle, x, y}};

std::span<const ClosureCondition> with_ball(CutShape b) {
  switch (b) {
    case CutShape::ball:
    case CutShape::cross: return one_distance;
    case CutShape::plane:
    case CutShape::turning_plane:
    case CutShape::sliding_plane: return point_of_a_in_plane_of_b;
    case CutShape::cylinder: return point_of_a_line_of_b;
    case CutShape::turn: return ball_turn;
    case CutShape::slide: return ball_slide;
  }
  return {};
}

std::span<const ClosureCondition> with_plane(CutShape b) {
  switch (b) {
    case CutShape::cross: return point_of_b_in_plane_of_a;
    case CutShape::plane:
    case CutShape::turning_plane:
    case CutShape::cylinder: return one_angle;
    case CutShape::turn: return plane_turn;
    case CutShape::slide: return plane_slide;
    case CutShape::ball:
    case CutShape::sliding_plane: return {};
  }
  return {};
}

std::span<const ClosureCondition> in_order(CutShape a, CutShape b) {
  if (a == CutShape::ball) return with_ball(b);
  if (a == CutShape::plane) return with_plane(b);
  if (a == CutShape::cylinder) {
    if (b == CutShape::cylinder) return two_lines;
    if (b == CutShape::turn) return cylinder_turn;
    if (b == CutShape::slide) return cylinder_slide;
  }
  if (a == CutShape::turn && b == CutShape::turn) return turn_turn;
  if (a == CutShape::turn && b == CutShape::slide) return turn_slide;
  if (a == CutShape::slide && b == CutShape::slide) return slide_slide;
  return {};
}

}  // namespace

std::span<const ClosureCondition> pair_conditions(CutShape a, CutShape b) { return in_order(a, b); }

bool up_to_mirror(CutShape a, CutShape b) {
  if (b == CutShape::slide) return a != CutShape::ball;
  return b == CutShape::turn && (a == CutShape::cylinder || a == CutShape::turn);
}

std::span<const ClosureCondition> joint_conditions(CutShape shape) {
  switch (shape) {
    case CutShape::ball: return of_ball;
    case CutShape::plane: return of_plane;
    case CutShape::cylinder: return of_cylinder;
    case CutShape::turn: return of_turn;
    case CutShape::slide: return of_slide;
    case CutShape::cross:
    case CutShape::turning_plane:
    case CutShape::sliding_plane: return {};
  }
  return {};
}

double size_of(const ClosureCondition& condition, double length) {
  switch (condition.type) {
    case point_point:
    case point_line: return length * length;
    case point_plane:
    case line_line: return length;
    case angle: return 1.0;
  }
  return 1.0;
}

}  // namespace koppel
