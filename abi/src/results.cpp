#include "boundary.hpp"
#include "closure/close.hpp"
#include "closure/recording.hpp"

namespace {

using koppel::Attachment;
using koppel::Mechanism;
using koppel::Pose;

bool has_poses(std::int32_t what) { return what == KOPPEL_KIND_BODY || what == KOPPEL_KIND_FRAME; }

std::size_t count_of(const Mechanism& m, std::int32_t what) {
  return what == KOPPEL_KIND_BODY ? m.bodies.size() : m.frames.size();
}

Attachment frame_of(const Mechanism& m, std::int32_t what, std::size_t i) {
  if (what == KOPPEL_KIND_FRAME) return m.frames[i].on;
  return {{static_cast<std::uint32_t>(i)}, Pose{}};
}

/// Forward kinematics at the state, then `write(kinematics, frame, out)` for each body or frame, `size` numbers each.
template <typename Write>
koppel_status each(const koppel_state* state, koppel_work* work, std::int32_t what, double* out, std::size_t count,
                   std::size_t size, const Write& write) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (!koppel::fit(state, work) || !has_poses(what)) return KOPPEL_INVALID_ARGUMENT;
    const Mechanism& m = *state->mechanism;
    const std::size_t things = count_of(m, what);
    if (count != size * things || (out == nullptr && count > 0)) return KOPPEL_INVALID_ARGUMENT;
    if (!koppel::realise(work->work, state->state)) return KOPPEL_PLUGIN;
    for (std::size_t i = 0; i < things; ++i) {
      write(work->work.equations.kinematics, frame_of(m, what, i), out + size * i);
    }
    return KOPPEL_OK;
  });
}

/// What joints and drives bear at the state.
koppel_status evaluate_loads(const koppel_state* state, koppel_work* work, koppel_error* error) {
  if (!work->reactions) {
    auto inertias = koppel::inertias(*state->mechanism);
    if (!inertias) return koppel::fail(inertias.error(), error);
    work->reactions = std::make_unique<koppel::Reactions>(state->mechanism, std::move(*inertias));
  }
  if (work->reactions->evaluate(state->state)) return KOPPEL_OK;
  return koppel::fail(
      koppel::make_error(koppel::Code::plugin_misbehaved, work->reactions->culprit(),
                         "failed, or gave a number that is not finite", "report it to the author of the plugin"),
      error);
}

void write_determined(const koppel::Reactions::Determined& from, std::uint8_t* to) {
  for (const auto& joint : from.joints) {
    for (const bool component : joint) *to++ = component ? 1 : 0;
  }
  for (const bool effort : from.efforts) *to++ = effort ? 1 : 0;
}

using RowMajor6 = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

koppel_status koppel_poses(const koppel_state* state, koppel_work* work, int32_t what, double* poses, size_t count) {
  return each(state, work, what, poses, count, 12,
              [](const koppel::Kinematics& kinematics, const Attachment& frame, double* out) {
                const Pose pose = koppel::pose_of(kinematics, frame.body.value, frame.pose);
                Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(out, 3, 3) = pose.rotation;
                Eigen::Map<koppel::Vector3>(out + 9, 3) = pose.position;
              });
}

koppel_status koppel_twists(const koppel_state* state, koppel_work* work, int32_t what, double* twists, size_t count) {
  return each(state, work, what, twists, count, 6,
              [](const koppel::Kinematics& kinematics, const Attachment& frame, double* out) {
                const auto motion = koppel::motion_of(kinematics, frame.body.value, frame.pose.position);
                Eigen::Map<koppel::Vector6>(out, 6) << motion.angular_velocity, motion.velocity;
              });
}

koppel_status koppel_frame_accelerations(const koppel_state* state, koppel_work* work, int32_t what,
                                         double* accelerations, size_t count) {
  return each(state, work, what, accelerations, count, 6,
              [](const koppel::Kinematics& kinematics, const Attachment& frame, double* out) {
                const auto motion = koppel::motion_of(kinematics, frame.body.value, frame.pose.position);
                Eigen::Map<koppel::Vector6>(out, 6) << motion.angular_acceleration, motion.acceleration;
              });
}

koppel_status koppel_jacobian(const koppel_state* state, koppel_work* work, int32_t what, size_t index,
                              double* jacobian, double* rate, size_t count) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (!koppel::fit(state, work) || jacobian == nullptr || !has_poses(what)) return KOPPEL_INVALID_ARGUMENT;
    const Mechanism& m = *state->mechanism;
    if (index >= count_of(m, what) || count != std::size_t{6} * m.nv) return KOPPEL_INVALID_ARGUMENT;
    if (!koppel::realise(work->work, state->state)) return KOPPEL_PLUGIN;
    koppel::Kinematics& kinematics = work->work.equations.kinematics;
    const Attachment frame = frame_of(m, what, index);
    koppel::Jacobian result;
    if (rate != nullptr) {
      if (!koppel::frame_jacobian_rate(m, state->state.q.data(), state->state.v.data(), kinematics, frame.body.value,
                                       frame.pose.position, result)) {
        return KOPPEL_PLUGIN;
      }
      Eigen::Map<RowMajor6>(rate, 6, m.nv) = result;
    }
    koppel::frame_jacobian(m, kinematics, frame.body.value, frame.pose.position, result);
    Eigen::Map<RowMajor6>(jacobian, 6, m.nv) = result;
    return KOPPEL_OK;
  });
}

koppel_status koppel_records(const koppel_state* state, koppel_work* work, double* values, size_t count) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (!koppel::fit(state, work) || values == nullptr) return KOPPEL_INVALID_ARGUMENT;
    if (count != state->mechanism->record_columns.size()) return KOPPEL_INVALID_ARGUMENT;
    const koppel::Loads* loads = nullptr;
    if (state->mechanism->records_loads) {
      if (const koppel_status status = evaluate_loads(state, work, nullptr); status < 0) return status;
      loads = &work->reactions->loads();
    }
    return koppel::evaluate_recording(work->work, state->state, loads, values);
  });
}

koppel_status koppel_reactions(const koppel_state* state, koppel_work* work, double* wrenches, size_t wrench_count,
                               double* efforts, size_t effort_count, uint8_t* determined, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) {
      return koppel::invalid_argument("state or work is NULL, or they belong to different mechanisms", error);
    }
    const Mechanism& m = *state->mechanism;
    if (wrench_count != 6 * m.joints.size() || effort_count != m.nv || (wrenches == nullptr && wrench_count > 0) ||
        (efforts == nullptr && effort_count > 0)) {
      return koppel::invalid_argument("there must be room for 6 numbers for each joint, and one for each rate", error);
    }
    if (!koppel::is_closed(m, state->state)) {
      return koppel::invalid_argument("the state is not closed: koppel_close comes first", error);
    }
    if (const koppel_status status = evaluate_loads(state, work, error); status < 0) return status;
    const koppel::Loads& loads = work->reactions->loads();
    for (const koppel::Wrench& joint : loads.joints) {
      Eigen::Map<koppel::Vector6>(wrenches, 6) = joint.vector();
      wrenches += 6;
    }
    Eigen::Map<Eigen::VectorXd>(efforts, m.nv) = loads.efforts;
    if (determined != nullptr) write_determined(work->reactions->determined(), determined);
    return KOPPEL_OK;
  });
}
