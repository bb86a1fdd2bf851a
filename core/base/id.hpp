// Numbers of things as types of their own: a BodyId cannot be passed for a JointId.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace koppel {

template <typename Tag>
struct Id {
  std::uint32_t value = 0;

  constexpr std::size_t index() const { return value; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

using BodyId = Id<struct BodyTag>;
using FrameId = Id<struct FrameTag>;
using JointId = Id<struct JointTag>;

/// The body that never moves; always the first.
inline constexpr BodyId ground{0};

}  // namespace koppel
