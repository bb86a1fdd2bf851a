#include "mechanism/state.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mechanism/coordinates.hpp"

namespace koppel {
namespace {

const CoordinateDescription& described(const Mechanism& mechanism, const StateBlock& block) {
  return mechanism.joints[block.joint.index()].blocks[block.block].described;
}

bool outside(const Mechanism& mechanism, const StateBlock& block, const Eigen::VectorXd& q) {
  const auto& limits = described(mechanism, block).limits;
  return limits && (q[block.q] < (*limits)[0] || q[block.q] > (*limits)[1]);
}

}  // namespace

State::State(const Mechanism& mechanism)
    : q(mechanism.nq),
      v(Eigen::VectorXd::Zero(mechanism.nv)),
      a(Eigen::VectorXd::Zero(mechanism.nv)),
      internal(mechanism.internal_start),
      input(mechanism.inputs.size()),
      input_rate(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mechanism.inputs.size()))),
      input_acceleration(input_rate) {
  history.sides.assign(mechanism.nv + std::size_t{1}, 0);
  for (const StateBlock& block : mechanism.blocks) {
    const CoordinateDescription& about = described(mechanism, block);
    neutral_block(block.kind, q.data() + block.q);
    if (is_scalar(block.kind)) q[block.q] = about.zero;
    if (about.start) std::copy(about.start->begin(), about.start->end(), q.data() + block.q);
    if (about.start_rate) std::copy(about.start_rate->begin(), about.start_rate->end(), v.data() + block.v);
  }
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    v[mechanism.inputs[i].v] = 0.0;
    input[static_cast<Eigen::Index>(i)] = q[mechanism.inputs[i].q];
  }
  history.acceleration.setZero(mechanism.nv);
  set_time(mechanism, 0.0, *this);
}

const Input* set_time(const Mechanism& mechanism, double time, State& state) {
  // Twice over: nothing is written before every function has answered.
  for (const bool write : {false, true}) {
    for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
      const Input& input = mechanism.inputs[i];
      if (input.type == nullptr) continue;
      std::array<double, 3> out;
      out.fill(std::nan(""));
      const void* instance = input.instance.get();
      if (input.type->calls.evaluate(1, &instance, &time, out.data()) < 0 ||
          !std::all_of(out.begin(), out.end(), [](double x) { return std::isfinite(x); })) {
        return &input;
      }
      if (!write) continue;
      const auto k = static_cast<Eigen::Index>(i);
      state.input[k] = out[0];
      state.input_rate[k] = out[1];
      state.input_acceleration[k] = out[2];
    }
  }
  state.time = time;
  return nullptr;
}

void integrate(const Mechanism& mechanism, const Eigen::VectorXd& q, const Eigen::VectorXd& delta,
               Eigen::VectorXd& result) {
  for (const StateBlock& block : mechanism.blocks) {
    integrate_block(block.kind, q.data() + block.q, delta.data() + block.v, result.data() + block.q);
  }
}

void difference(const Mechanism& mechanism, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                Eigen::VectorXd& delta) {
  for (const StateBlock& block : mechanism.blocks) {
    difference_block(block.kind, from.data() + block.q, to.data() + block.q, delta.data() + block.v);
  }
}

std::vector<std::string> limits_exceeded(const Mechanism& mechanism, const State& state) {
  std::vector<std::string> names;
  for (const StateBlock& block : mechanism.blocks) {
    if (outside(mechanism, block, state.q)) names.push_back(mechanism.coordinate_names[block.q].name);
  }
  return names;
}

bool any_limit_exceeded(const Mechanism& mechanism, const Eigen::VectorXd& q) {
  return std::any_of(mechanism.blocks.begin(), mechanism.blocks.end(),
                     [&](const StateBlock& block) { return outside(mechanism, block, q); });
}

}  // namespace koppel
