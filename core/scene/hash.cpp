#include <bit>

#include "scene/reading.hpp"

namespace koppel {
namespace {

/// Fowler, Noll and Vo's hash, variant 1a, over a stream of fields. Lists and texts are preceded by their length, so
/// that no two scenes give the same stream.
class Stream {
 public:
  std::uint64_t hash() const { return hash_; }

  void add(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) byte(static_cast<unsigned char>(value >> shift));
  }
  /// Negative zero counts as zero.
  void add(double value) { add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }
  void add(std::string_view text) {
    add(std::uint64_t{text.size()});
    for (const char c : text) byte(static_cast<unsigned char>(c));
  }
  void add(const std::string& text) { add(std::string_view(text)); }
  void add(bool value) { add(std::uint64_t{value}); }
  template <typename Tag>
  void add(Id<Tag> id) {
    add(std::uint64_t{id.value});
  }
  void add(const Vector3& v) {
    for (const double x : v) add(x);
  }
  void add(const Pose& pose) {
    for (const double x : pose.rotation.reshaped<Eigen::RowMajor>()) add(x);
    add(pose.position);
  }
  void add(const Attachment& attachment) {
    add(attachment.body);
    add(attachment.pose);
  }
  void add(const CoordinateReference& coordinate) {
    add(coordinate.joint);
    add(std::uint64_t{coordinate.block});
  }
  /// What was given and what came from a fallback is the same if the numbers are.
  void add(const Value& value) {
    add(std::uint64_t{value.count});
    add(value.numbers);
    add(value.text);
  }
  void add(const CoordinateDescription& coordinate) {
    add(coordinate.zero);
    add(coordinate.start.has_value());
    if (coordinate.start) add(*coordinate.start);
    add(coordinate.limits.has_value());
    if (coordinate.limits) {
      for (const double limit : *coordinate.limits) add(limit);
    }
    add(coordinate.start_rate.has_value());
    if (coordinate.start_rate) add(*coordinate.start_rate);
    if (coordinate.fixed) add(std::string_view("fixed"));
  }
  template <typename Item>
  void add(const std::vector<Item>& items) {
    add(std::uint64_t{items.size()});
    for (const Item& item : items) add(item);
  }
  void add(const Type* type) { add(type == nullptr ? std::string_view() : std::string_view(type->name)); }

  void add(const BodyDescription& body) {
    add(body.name);
    add(body.type);
    add(body.values);
    add(body.design);
  }
  void add(const FrameDescription& frame) {
    add(frame.name);
    add(frame.on);
  }
  void add(const JointDescription& joint) {
    add(joint.name);
    add(joint.type);
    add(joint.values);
    add(joint.inlet);
    add(joint.outlet);
    add(joint.coordinates);
  }
  void add(const ConstraintDescription& constraint) {
    add(constraint.name);
    add(constraint.type);
    add(constraint.values);
    add(constraint.frames);
    add(constraint.coordinates);
  }
  void add(const ForceDescription& force) {
    add(force.name);
    add(force.type);
    add(force.values);
    add(force.frames);
    add(force.coordinates);
  }
  void add(const SimulationDescription& simulation) {
    for (const auto& number : {simulation.tolerance, simulation.step}) {
      add(number.has_value());
      add(number.value_or(0.0));
    }
    // Scenes without one keep the hash that they had before there was a choice.
    if (!simulation.integrator.empty()) add(simulation.integrator);
    if (!simulation.formulation.empty()) add("formulation " + simulation.formulation);
  }
  void add(const DriveDescription& drive) {
    add(drive.name);
    add(drive.of);
    add(drive.type);
    add(drive.values);
  }
  void add(const WatchDescription& watch) {
    add(watch.name);
    add(watch.of);
    add(watch.rate);
    add(watch.value);
    add(static_cast<std::uint64_t>(watch.direction));
    add(watch.stop);
  }
  void add(const RecordDescription& record) {
    add(record.name);
    add(static_cast<std::uint64_t>(record.subject));
    add(static_cast<std::uint64_t>(record.quantity));
    add(record.joint);
    add(std::uint64_t{record.block});
    add(record.frame);
    // Scenes without these keep the hash that they had before there were any.
    if (record.against) add(*record.against);
    if (record.by) add(*record.by);
  }

 private:
  void byte(unsigned char value) { hash_ = (hash_ ^ value) * 0x100000001b3u; }

  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
  Stream stream;
  stream.add(scene.name);
  stream.add(scene.title);
  stream.add(scene.gravity);
  stream.add(scene.length.has_value());
  stream.add(scene.length.value_or(0.0));
  stream.add(scene.duration);
  stream.add(std::uint64_t{scene.steps});
  stream.add(scene.simulation);
  stream.add(scene.bodies);
  stream.add(scene.frames);
  stream.add(scene.joints);
  stream.add(scene.constraints);
  stream.add(scene.forces);
  stream.add(scene.drives);
  stream.add(scene.records);
  // As above.
  if (!scene.watches.empty()) stream.add(scene.watches);
  return stream.hash();
}

}  // namespace koppel
