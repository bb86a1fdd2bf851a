#include "plugin/motion.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>

#include "plugin/copy.hpp"
#include "plugin/host.hpp"
#include "plugin/library.hpp"

namespace koppel {
namespace {

constexpr double axis_tolerance = 1e-9;
constexpr double unset = std::numeric_limits<double>::quiet_NaN();

/// What stands where a plugin has written nothing.
constexpr koppel_motion blank = {
    sizeof(koppel_motion), 0,    std::numeric_limits<std::uint32_t>::max(), {unset, unset, unset},
    {unset, unset, unset}, unset};

bool is_blank(const koppel_motion& m) { return m.kind == blank.kind && m.coordinate == blank.coordinate; }

struct Finding {
  Code code;
  std::string text;
};

std::optional<BlockKind> moving_block(int32_t motion_kind) {
  switch (motion_kind) {
    case KOPPEL_MOTION_ROTATION:
    case KOPPEL_MOTION_SCREW: return BlockKind::angle;
    case KOPPEL_MOTION_TRANSLATION: return BlockKind::line;
    case KOPPEL_MOTION_FREE_ROTATION: return BlockKind::quaternion;
    default: return std::nullopt;
  }
}

bool is_finite(const double (&v)[3]) {
  return std::all_of(std::begin(v), std::end(v), [](double x) { return std::isfinite(x); });
}

std::optional<Finding> check_numbers(koppel_motion& m) {
  if (m.kind == KOPPEL_MOTION_FREE_ROTATION) {
    std::fill(std::begin(m.axis), std::end(m.axis), 0.0);
  } else {
    if (!is_finite(m.axis)) return Finding{Code::plugin_misbehaved, "its axis is not finite"};
    const double length = std::hypot(m.axis[0], m.axis[1], m.axis[2]);
    if (std::abs(length - 1.0) > axis_tolerance) {
      return Finding{Code::plugin_malformed, "its axis has length " + std::to_string(length) + ", not 1"};
    }
    for (double& component : m.axis) component /= length;
  }
  if (m.kind == KOPPEL_MOTION_TRANSLATION) std::fill(std::begin(m.point), std::end(m.point), 0.0);
  if (!is_finite(m.point)) return Finding{Code::plugin_misbehaved, "its point is not finite"};
  if (m.kind != KOPPEL_MOTION_SCREW) m.pitch = 0.0;
  if (!std::isfinite(m.pitch)) return Finding{Code::plugin_misbehaved, "its pitch is not finite"};
  return std::nullopt;
}

std::optional<Finding> check_motion(koppel_motion& m, const std::vector<Block>& blocks, std::vector<bool>& moved) {
  const auto kind = moving_block(m.kind);
  if (!kind) return Finding{Code::plugin_malformed, "its kind is " + std::to_string(m.kind)};
  if (m.coordinate >= blocks.size()) {
    return Finding{Code::plugin_malformed,
                   "it names coordinate " + std::to_string(m.coordinate) + " of " + std::to_string(blocks.size())};
  }
  const Block& block = blocks[m.coordinate];
  if (moved[m.coordinate]) {
    return Finding{Code::plugin_malformed, "coordinate `" + block.name + "` moves another one already"};
  }
  moved[m.coordinate] = true;
  if (block.kind != *kind) {
    return Finding{Code::plugin_malformed, "coordinate `" + block.name + "` is of another kind than the motion"};
  }
  return check_numbers(m);
}

}  // namespace

Result<std::vector<koppel_motion>> joint_motions(const JointType& type, const Instance& instance) {
  const std::size_t count = type.blocks.size();
  if (count == 0) return std::vector<koppel_motion>();
  const auto fault = [&type](Code code, const std::string& what) {
    return tl::make_unexpected(plugin_error(code, type.origin, "type `" + type.name + "`: motions() " + what));
  };
  // Room for more than what is asked for, so that a plugin that writes too much is caught before it does harm.
  std::vector<koppel_motion> written(2 * count + 6, blank);
  const auto status = guarded([&] { return type.calls.motions(instance.get(), written.data()); });
  if (!status || *status < 0) return fault(Code::plugin_misbehaved, describe_failure(status));

  // A plugin of an older version may know a shorter struct: the first one tells how far they are apart.
  const std::size_t stride = written.front().struct_size;
  if (stride < size_through(&koppel_motion::pitch) || stride > sizeof(koppel_motion) ||
      stride % alignof(koppel_motion) != 0) {
    return fault(Code::plugin_malformed, "sets struct_size to " + std::to_string(stride));
  }
  std::vector<koppel_motion> out;
  std::vector<bool> moved(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(*array_element(written.data(), stride, i));
    if (is_blank(out.back())) {
      return fault(Code::plugin_malformed,
                   "writes " + std::to_string(i) + " motions for " + std::to_string(count) + " coordinates");
    }
    out.back().struct_size = sizeof(koppel_motion);
    if (const auto finding = check_motion(out.back(), type.blocks, moved)) {
      return fault(finding->code, "motion " + std::to_string(i) + ": " + finding->text);
    }
  }
  if (stride == sizeof(koppel_motion) && !is_blank(written[count])) {
    return fault(Code::plugin_malformed,
                 "writes more motions than there are coordinates (" + std::to_string(count) + ')');
  }
  return out;
}

}  // namespace koppel
