#include "dynamics/tree_layout.hpp"

namespace koppel {

TreeLayout::TreeLayout(const Mechanism& mechanism) : mechanism_(&mechanism), number_(mechanism.nv, none) {
  std::vector<std::uint32_t> last_rate(mechanism.nodes, none);
  for (const TreeStep& step : mechanism.steps) {
    add_rates(step, last_rate[step.parent]);
    last_rate[step.child] = steps_.back().rates > 0 ? rates() - 1 : last_rate[step.parent];
  }
  for (std::uint32_t p = 0; p < rates(); ++p) add_runs(p);
  // Every rate is one of those beyond the joints before it.
  std::vector<std::uint32_t> beyond(mechanism.nodes, 0);
  for (std::size_t i = steps_.size(); i-- > 0;) {
    Step& step = steps_[i];
    step.subtree_rates = beyond[step.child];
    beyond[step.parent] += beyond[step.child] + step.rates;
  }
}

void TreeLayout::add_rates(const TreeStep& step, std::uint32_t parent_rate) {
  const Joint& joint = mechanism_->joints[step.joint.index()];
  steps_.push_back({step.parent, step.child, rates(), joint.nv, parent_rate, 0, joint.is_product()});
  const auto append = [&](std::uint32_t rate) {
    number_[rate] = rates();
    parent_.push_back(parent_rate);
    depth_.push_back(parent_rate == none ? 1 : depth_[parent_rate] + 1);
    first_.push_back(entries_);
    entries_ += depth_.back();
    parent_rate = rates();
    rate_.push_back(rate);
  };
  for (std::uint32_t k = 0; k < joint.nv; ++k) append(joint.v + k);
}

void TreeLayout::add_runs(std::uint32_t p) {
  first_run_.push_back(static_cast<std::uint32_t>(runs_.size()));
  const std::uint32_t before = parent_[p];
  if (before != none) {
    for (std::uint32_t k = 0; k < run_count_[before]; ++k) runs_.push_back(runs_[first_run_[before] + k]);
  }
  if (before != none && before + 1 == p) {
    ++runs_.back().count;
  } else {
    runs_.push_back({p, 1, depth_[p] - 1});
  }
  run_count_.push_back(static_cast<std::uint32_t>(runs_.size()) - first_run_[p]);
}

}  // namespace koppel
