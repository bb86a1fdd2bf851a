#include "stream/encoder.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "koppel/closure_t.hpp"
#include "koppel/event_t.hpp"
#include "koppel/model_t.hpp"
#include "koppel/poses_t.hpp"
#include "koppel/state_t.hpp"
#include "spatial/quaternion.hpp"

namespace koppel {
namespace {

std::int32_t count_of(std::size_t size) { return static_cast<std::int32_t>(size); }

void split_names(const std::vector<NameAndUnit>& from, std::int32_t& count, std::vector<std::string>& names,
                 std::vector<std::string>& units) {
  count = count_of(from.size());
  for (const NameAndUnit& entry : from) {
    names.push_back(entry.name);
    units.push_back(entry.unit);
  }
}

model_t model_message(const StreamModel& model) {
  model_t message{};
  message.hash = std::bit_cast<std::int64_t>(model.hash);
  message.scene = model.scene;
  message.title = model.title;
  message.version = model.version;
  message.length = model.length;
  split_names(model.coordinates, message.coordinate_count, message.coordinate_names, message.coordinate_units);
  split_names(model.rates, message.rate_count, message.rate_names, message.rate_units);
  message.joint_count = count_of(model.joints.size());
  message.joint_names = model.joints;
  message.body_count = count_of(model.bodies.size());
  message.body_names = model.bodies;
  return message;
}

/// pose: rotation matrix row by row, then the position.
void set_pose(pose_t& message, const double* pose) {
  const Matrix3 rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose);
  const Vector4 quaternion = quaternion_of_rotation<double>(rotation);
  std::copy_n(pose + 9, 3, message.position);
  std::copy_n(quaternion.data(), 4, message.quaternion);
}

void set_closure(closure_t& message, const ClosureFigures& figures) {
  message.verdict = figures.verdict;
  message.solver = figures.solver;
  message.status = figures.status;
  message.iterations = static_cast<std::int32_t>(figures.iterations);
  message.rank = static_cast<std::int32_t>(figures.rank);
  message.equations = static_cast<std::int32_t>(figures.equations);
  message.unknowns = static_cast<std::int32_t>(figures.unknowns);
  message.residual = figures.residual;
  message.condition = figures.condition;
  message.coordinate_error = figures.coordinate_error;
}

/// The head that all messages begin with, but for the hash, which never changes.
template <typename Message>
void set_head(Message& message, std::int64_t utime, double time, std::int64_t sequence) {
  message.utime = utime;
  message.time = time;
  message.sequence = sequence;
}

/// A message and the channel it goes out on.
template <typename Message>
struct Outgoing {
  std::string channel;
  Message message{};

  bool send(Sink& sink, std::vector<std::uint8_t>& buffer) const {
    const int size = message.getEncodedSize();
    buffer.resize(static_cast<std::size_t>(size));
    return message.encode(buffer.data(), 0, size) == size && sink.send(channel, buffer);
  }
};

}  // namespace

struct Encoder::Messages {
  Outgoing<model_t> model;
  Outgoing<state_t> state;
  Outgoing<poses_t> poses;
  Outgoing<closure_t> closure;
  Outgoing<event_t> event;
  std::vector<std::uint8_t> buffer;
};

Encoder::Encoder(const StreamModel& model, const std::string& stem) : messages_(std::make_unique<Messages>()) {
  const std::string prefix = "KOPPEL_" + stem;
  Messages& m = *messages_;
  m.model = {prefix + "_MODEL", model_message(model)};
  m.state.channel = prefix + "_STATE";
  m.state.message.coordinate_count = count_of(model.coordinates.size());
  m.state.message.rate_count = count_of(model.rates.size());
  m.poses.channel = prefix + "_POSES";
  m.poses.message.body_count = count_of(model.bodies.size());
  m.poses.message.poses.resize(model.bodies.size());
  m.closure.channel = prefix + "_CLOSURE";
  m.event.channel = prefix + "_EVENT";
  m.model.message.sequence = -1;  // counted up before each sending
  const std::int64_t hash = m.model.message.hash;
  m.state.message.hash = m.poses.message.hash = m.closure.message.hash = m.event.message.hash = hash;
}

Encoder::~Encoder() = default;

bool Encoder::send_model(Sink& sink, std::int64_t utime) {
  auto& model = messages_->model;
  // The model's time is that of the last snapshot.
  set_head(model.message, utime, messages_->state.message.time, model.message.sequence + 1);
  return model.send(sink, messages_->buffer);
}

bool Encoder::send(Sink& sink, const Slot& slot) {
  Messages& m = *messages_;
  set_head(m.state.message, slot.utime, slot.time, slot.sequence);
  m.state.message.q = slot.q;
  m.state.message.v = slot.v;
  m.state.message.a = slot.a;
  bool sent = m.state.send(sink, m.buffer);

  set_head(m.poses.message, slot.utime, slot.time, slot.sequence);
  for (std::size_t body = 0; body < m.poses.message.poses.size(); ++body)
    set_pose(m.poses.message.poses[body], slot.poses.data() + 12 * body);
  sent = m.poses.send(sink, m.buffer) && sent;

  if (!slot.closure) return sent;
  set_head(m.closure.message, slot.utime, slot.time, slot.sequence);
  set_closure(m.closure.message, *slot.closure);
  return m.closure.send(sink, m.buffer) && sent;
}

bool Encoder::send(Sink& sink, const Event& event) {
  auto& out = messages_->event;
  set_head(out.message, event.utime, event.time, event.sequence);
  out.message.severity = static_cast<std::int32_t>(event.severity);
  out.message.text = event.text;
  return out.send(sink, messages_->buffer);
}

}  // namespace koppel
