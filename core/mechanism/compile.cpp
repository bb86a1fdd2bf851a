// From a Scene to a Mechanism.
#include <algorithm>
#include <cmath>
#include <set>

#include "mechanism/mechanism.hpp"
#include "mechanism/names.hpp"
#include "mechanism/topology.hpp"

namespace koppel {

/// Builds one Mechanism, part by part; each part only needs those before it.
class Compiler {
 public:
  Compiler(const Scene& scene, Diagnostics& diagnostics, bool start_held)
      : scene_(scene), diagnostics_(diagnostics), start_held_(start_held), mechanism_(new Mechanism) {}

  Result<std::unique_ptr<Mechanism>> run() {
    copy_settings();
    KOPPEL_CHECK(build_joints());
    KOPPEL_CHECK(build_inputs());
    KOPPEL_CHECK(build_constraints());
    KOPPEL_CHECK(build_forces());
    take_length();
    build_tree();
    number_columns();
    build_loops();
    build_constraint_relations();
    number_rows();
    m().record_columns = record_columns(m());
    for (std::uint32_t i = 0; i < m().inputs.size(); ++i) {
      const auto by_it = [&](const RecordDescription& record) { return record.by && *record.by == m().inputs[i].of; };
      if (std::any_of(m().records.begin(), m().records.end(), by_it)) m().record_inputs.push_back(i);
    }
    m().records_loads = std::any_of(m().records.begin(), m().records.end(), [](const RecordDescription& record) {
      return record.subject == RecordSubject::joint_load || record.quantity == Quantity::effort;
    });
    return std::move(mechanism_);
  }

 private:
  Mechanism& m() { return *mechanism_; }

  void copy_settings() {
    m().name = scene_.name;
    m().title = scene_.title;
    m().gravity = scene_.gravity;
    m().duration = scene_.duration;
    m().run_steps = scene_.steps;
    m().simulation = scene_.simulation;
    m().hash = scene_.hash;
    m().frames = scene_.frames;
    m().records = scene_.records;
    for (const BodyDescription& body : scene_.bodies) m().bodies.push_back({body.name, body.type, body.values});
  }

  Result<void> build_joints() {
    for (const JointDescription& description : scene_.joints) {
      KOPPEL_TRY(Joint joint, Joint::build(description));
      joint.q = m().nq;
      joint.v = m().nv;
      m().nq += joint.nq;
      m().nv += joint.nv;
      const JointId id{static_cast<std::uint32_t>(m().joints.size())};
      for (std::uint32_t i = 0; i < joint.blocks.size(); ++i) {
        const JointBlock& block = joint.blocks[i];
        m().blocks.push_back({block.kind, id, i, joint.q + block.q, joint.v + block.v});
      }
      m().joints.push_back(std::move(joint));
    }
    for (const WatchDescription& watch : scene_.watches) {
      const Joint& joint = m().joints[watch.of.joint.index()];
      const JointBlock& block = joint.blocks[watch.of.block];
      const std::uint32_t at = watch.rate ? joint.v + block.v : joint.q + block.q;
      m().watches.push_back({watch.name, watch.rate, at, watch.value, watch.direction, watch.stop});
    }
    m().coordinate_names = coordinate_names(m());
    m().rate_names = rate_names(m());
    must_stay_.assign(m().joints.size(), false);
    driven_.assign(m().nv, false);
    return {};
  }

  /// Where a scalar coordinate is in the state. Its joint cannot be the one that is left out of the tree.
  const JointBlock& claim(const CoordinateReference& of) {
    must_stay_[of.joint.index()] = true;
    return m().joints[of.joint.index()].blocks[of.block];
  }

  Result<void> build_inputs() {
    for (const DriveDescription& drive : scene_.drives) {
      auto instance = drive.type->create(drive.values);
      if (!instance) return refused(std::move(instance).error(), drive.source, "drive " + drive.name);
      const Joint& joint = m().joints[drive.of.joint.index()];
      const JointBlock& block = claim(drive.of);
      driven_[joint.v + block.v] = true;
      m().inputs.push_back(
          {drive.name, drive.of, joint.q + block.q, joint.v + block.v, drive.type, std::move(*instance)});
    }
    if (start_held_) hold_start();
    return {};
  }

  void hold_start() {
    for (const StateBlock& block : m().blocks) {
      const CoordinateDescription& described = m().joints[block.joint.index()].blocks[block.block].described;
      if (!described.fixed || !described.start || driven_[block.v]) continue;
      const CoordinateReference of{block.joint, block.block};
      claim(of);
      driven_[block.v] = true;
      m().inputs.push_back({"start of " + m().coordinate_names[block.q].name, of, block.q, block.v, nullptr, {}});
    }
  }

  Result<void> build_constraints() {
    for (const ConstraintDescription& description : scene_.constraints) {
      auto instance = description.type->create(description.values);
      if (!instance) {
        return refused(std::move(instance).error(), description.source, "constraint " + description.name);
      }
      Constraint constraint{description.name, description.type, std::move(*instance), {}, {}};
      for (const CoordinateReference& of : description.coordinates) {
        const JointBlock& block = claim(of);
        constraint.q.push_back(m().joints[of.joint.index()].q + block.q);
        constraint.v.push_back(m().joints[of.joint.index()].v + block.v);
      }
      m().constraints.push_back(std::move(constraint));
    }
    return {};
  }

  Result<void> build_forces() {
    for (const ForceDescription& description : scene_.forces) {
      auto instance = description.type->create(description.values);
      if (!instance) return refused(std::move(instance).error(), description.source, "force " + description.name);
      Force force;
      force.name = description.name;
      force.type = description.type;
      force.instance = std::move(*instance);
      place(force, description.frames);
      for (const CoordinateReference& of : description.coordinates) {
        const JointBlock& block = claim(of);
        force.q.push_back(m().joints[of.joint.index()].q + block.q);
        force.v.push_back(m().joints[of.joint.index()].v + block.v);
      }
      KOPPEL_CHECK(start_internal_states(force, description.source));
      m().forces.push_back(std::move(force));
    }
    return {};
  }

  Result<void> start_internal_states(Force& force, const Source& source) {
    Eigen::VectorXd& start = m().internal_start;
    const auto before = start.size(), count = static_cast<Eigen::Index>(force.type->states.size());
    force.first_state = static_cast<std::uint32_t>(before);
    start.conservativeResize(before + count);
    start.tail(count).setZero();
    if (count == 0 || force.type->calls.initial == nullptr) return {};
    start.tail(count).setConstant(std::nan(""));
    const void* instance = force.instance.get();
    if (force.type->calls.initial(1, &instance, start.data() + before) >= 0 && start.tail(count).allFinite()) return {};
    Error error = make_error(
        Code::plugin_misbehaved, "force " + force.name,
        "type " + force.type->name + " (" + force.type->origin + ") gives no finite internal states to start from",
        "report it to the author of the plugin");
    return refused(std::move(error), source, "force " + force.name);
  }

  /// A body's node is its first half, wherever it may be cut.
  static void place(Force& force, const std::vector<Attachment>& frames) {
    force.has_frames = !frames.empty();
    if (frames.empty()) return;
    force.node_b = frames.back().body.value;
    force.pose_b = frames.back().pose;
    if (frames.size() < 2) return;
    force.node_a = frames.front().body.value;
    force.pose_a = frames.front().pose;
  }

  static Result<void> refused(Error error, const Source& source, std::string element) {
    error.source = source;
    error.element = std::move(element);
    return tl::make_unexpected(std::move(error));
  }

  /// The largest distance between two joint frames on one body, unless the scene sets it. The ground, which may carry
  /// many small mechanisms, counts for no more than a hundred times what moves.
  void take_length() {
    constexpr double more_than_moves = 100.0;
    double longest = 0.0, moving = 0.0, reach = 0.0;
    std::vector<std::vector<Vector3>> points(m().bodies.size());
    for (const Joint& joint : m().joints) {
      for (const Attachment* side : {&joint.inlet, &joint.outlet}) {
        reach = std::max(reach, side->pose.position.norm());
        for (const Vector3& other : points[side->body.index()]) {
          double& of_kind = side->body == ground ? longest : moving;
          of_kind = std::max(of_kind, (side->pose.position - other).norm());
        }
        points[side->body.index()].push_back(side->pose.position);
      }
    }
    // Joints that would be at one point but for the rounding of how it is written are no distance apart.
    constexpr double rounding = 1e-12;
    if (moving > rounding * reach) longest = std::clamp(longest, moving, more_than_moves * moving);
    const bool apart = longest > rounding * reach;
    m().length = scene_.length.value_or(apart ? longest : 1.0);
    if (!scene_.length && !apart) {
      Error note = make_error(Code::no_length, "scene " + m().name,
                              "no two joints of a body are apart, so residuals in metres are taken as they are",
                              "set length in [scene] to the size of the mechanism");
      note.severity = Severity::note;
      diagnostics_.add(std::move(note));
    }
    for (Joint& joint : m().joints) joint.set_length(m().length);
    for (const StateBlock& block : m().blocks) {
      m().rate_scale.insert(m().rate_scale.end(), rate_count(block.kind),
                            block.kind == BlockKind::line ? m().length : 1.0);
    }
  }

  void build_tree() {
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < m().joints.size(); ++i) {
      const Joint& joint = m().joints[i];
      faces_.push_back(must_stay_[i] ? std::nullopt : Face::of(joint));
      const std::size_t cost = faces_[i] ? faces_[i]->rows().size() : 6;
      edges.push_back({joint.inlet.body, joint.outlet.body, static_cast<std::uint32_t>(cost)});
    }
    const Topology topology = span(m().bodies.size(), edges);
    m().nodes = static_cast<Node>(m().bodies.size());
    for (const Branch& branch : topology.branches) {
      const bool reversed = m().joints[branch.joint.index()].inlet.body != branch.parent;
      add_step(branch.joint, branch.parent.value, branch.child.value, reversed);
    }
    for (const JointId chord : topology.chords) {
      const Joint& joint = m().joints[chord.index()];
      Relation loop;
      loop.joint = chord;
      if (faces_[chord.index()]) {
        loop.kind = RelationKind::cut_joint;
        loop.face = faces_[chord.index()];
        loop.node_a = joint.inlet.body.value;
        loop.pose_a = joint.inlet.pose;
        loop.node_b = joint.outlet.body.value;
      } else {
        loop.kind = RelationKind::cut_body;
        loop.node_a = joint.outlet.body.value;
        loop.pose_a = joint.outlet.pose;
        loop.node_b = m().nodes++;
        add_step(chord, joint.inlet.body.value, loop.node_b, false);
      }
      loop.pose_b = joint.outlet.pose;
      m().relations.push_back(std::move(loop));
    }
    m().loops = static_cast<std::uint32_t>(m().relations.size());
  }

  void add_step(JointId id, Node parent, Node child, bool reversed) {
    const Joint& joint = m().joints[id.index()];
    const Pose& near = reversed ? joint.outlet.pose : joint.inlet.pose;
    const Pose& far = reversed ? joint.inlet.pose : joint.outlet.pose;
    const auto identity = [](const Pose& pose) { return pose.rotation.isIdentity(0.0) && pose.position.isZero(0.0); };
    m().steps.push_back({id, parent, child, reversed, near, far.inverse(), identity(near), identity(far)});
  }

  void number_columns() {
    m().column_of_rate.assign(m().nv, -1);
    for (const bool driven : {false, true}) {
      for (const TreeStep& step : m().steps) {
        const Joint& joint = m().joints[step.joint.index()];
        for (std::uint32_t v = joint.v; v < joint.v + joint.nv; ++v) {
          if (driven_[v] != driven) continue;
          m().column_of_rate[v] = static_cast<std::int32_t>(m().rate_of_column.size());
          m().rate_of_column.push_back(v);
        }
      }
      if (!driven) m().unknowns = static_cast<std::uint32_t>(m().rate_of_column.size());
    }
    m().columns = static_cast<std::uint32_t>(m().rate_of_column.size());
    step_to_.assign(m().nodes, nullptr);
    for (const TreeStep& step : m().steps) step_to_[step.child] = &step;
  }

  PathRate path_rate(std::uint32_t v, double sign) {
    return {static_cast<std::uint32_t>(m().column_of_rate[v]), v, sign};
  }

  /// The rates between two nodes: those on the way from the last common node to b, and negative those to a.
  void find_path(Relation& relation) {
    std::set<const TreeStep*> to_a, to_b;
    for (const TreeStep* s = step_to_[relation.node_a]; s != nullptr; s = step_to_[s->parent]) to_a.insert(s);
    for (const TreeStep* s = step_to_[relation.node_b]; s != nullptr; s = step_to_[s->parent]) to_b.insert(s);
    for (const TreeStep& step : m().steps) {
      const bool a = to_a.contains(&step), b = to_b.contains(&step);
      if (a == b) continue;
      const Joint& joint = m().joints[step.joint.index()];
      relation.joints.push_back(step.joint);
      for (std::uint32_t v = joint.v; v < joint.v + joint.nv; ++v) {
        relation.path.push_back(path_rate(v, b ? 1.0 : -1.0));
      }
    }
  }

  void build_loops() {
    for (Relation& loop : m().relations) find_path(loop);
  }

  void build_constraint_relations() {
    for (std::uint32_t i = 0; i < m().constraints.size(); ++i) {
      const Constraint& constraint = m().constraints[i];
      const ConstraintDescription& description = scene_.constraints[i];
      Relation relation;
      relation.kind = RelationKind::constraint;
      relation.constraint = i;
      relation.has_frames = description.frames.size() == 2;
      m().explicit_time = m().explicit_time || constraint.type->calls.time_rate != nullptr;
      if (relation.has_frames) {
        relation.node_a = description.frames[0].body.value;
        relation.pose_a = description.frames[0].pose;
        relation.node_b = description.frames[1].body.value;
        relation.pose_b = description.frames[1].pose;
        find_path(relation);
      }
      for (const std::uint32_t v : constraint.v) relation.coupled.push_back(path_rate(v, 1.0));
      for (const CoordinateReference& of : description.coordinates) {
        const auto known = std::find(relation.joints.begin(), relation.joints.end(), of.joint);
        if (known == relation.joints.end()) relation.joints.push_back(of.joint);
      }
      m().relations.push_back(std::move(relation));
    }
  }

  void number_rows() {
    for (Relation& relation : m().relations) {
      const std::vector<Row> rows = relation_rows(m(), relation);
      relation.first_row = m().rows;
      relation.rows = static_cast<std::uint32_t>(rows.size());
      m().rows += relation.rows;
      for (const Row& row : rows) {
        m().row_scale.push_back(row.unit == "m" ? 1.0 / m().length : 1.0);
        m().equation_names.push_back({relation_name(m(), relation) + ": " + row.name, row.unit});
      }
    }
    m().mobility_count = static_cast<std::int32_t>(m().nv) - 6 * static_cast<std::int32_t>(m().loops);
    for (std::size_t i = m().loops; i < m().relations.size(); ++i) {
      m().mobility_count -= static_cast<std::int32_t>(m().relations[i].rows);
    }
  }

  const Scene& scene_;
  Diagnostics& diagnostics_;
  bool start_held_ = false;
  std::unique_ptr<Mechanism> mechanism_;
  std::vector<bool> must_stay_;  ///< joints whose coordinates are used and so must be unknowns or inputs
  std::vector<bool> driven_;     ///< by rate
  std::vector<std::optional<Face>> faces_;
  std::vector<const TreeStep*> step_to_;
};

Result<std::shared_ptr<const Mechanism>> compile(const Scene& scene, Diagnostics& diagnostics) {
  KOPPEL_TRY(std::unique_ptr<Mechanism> mechanism, Compiler(scene, diagnostics, false).run());
  const bool fixed = std::any_of(scene.joints.begin(), scene.joints.end(), [](const JointDescription& joint) {
    return std::any_of(joint.coordinates.begin(), joint.coordinates.end(),
                       [](const CoordinateDescription& c) { return c.fixed && c.start; });
  });
  if (fixed) {
    Diagnostics said_already;
    KOPPEL_TRY(mechanism->with_start_held, Compiler(scene, said_already, true).run());
  }
  return std::shared_ptr<const Mechanism>(std::move(mechanism));
}

const Relation* Mechanism::cut_at(JointId joint) const {
  for (std::uint32_t i = 0; i < loops; ++i) {
    if (relations[i].kind == RelationKind::cut_joint && relations[i].joint == joint) return &relations[i];
  }
  return nullptr;
}

}  // namespace koppel
