// The spanning tree as the recursions of dynamics walk it: rates numbered from the ground outwards, each with the rates
// that it rests on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mechanism/mechanism.hpp"

namespace koppel {

/// Built once for a mechanism, shared by threads. Borrows the mechanism.
///
/// Rates of tree joints are numbered in walking order: joint by joint from the ground outwards, within a joint as in v.
/// The ancestors of a rate are those of the joints on the way to the ground, those before it in its own joint, and
/// itself: at depth 0 the one at the ground, at its own depth - 1 the rate itself. Rates of cut joints have no number.
class TreeLayout {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  /// A joint with the bodies beyond it.
  struct Step {
    Node parent = 0, child = 0;
    std::uint32_t first = 0, rates = 0;  ///< its rates, in walking order
    std::uint32_t parent_rate = none;    ///< the last rate before the joint
    std::uint32_t subtree_rates = 0;     ///< the number of rates beyond the joint
    bool is_product = true;
  };

  /// Rates of ancestors that stand side by side, in walking order as well as in depth.
  struct Run {
    std::uint32_t first = 0, count = 0, depth = 0;
  };

  explicit TreeLayout(const Mechanism& mechanism);

  const Mechanism& mechanism() const { return *mechanism_; }
  const std::vector<Step>& steps() const { return steps_; }  ///< as Mechanism::steps

  std::uint32_t rates() const { return static_cast<std::uint32_t>(rate_.size()); }
  std::uint32_t entries() const { return entries_; }  ///< of all rates with their ancestors

  /// Where a rate stands in v.
  std::uint32_t rate(std::uint32_t p) const { return rate_[p]; }
  /// The number of a rate in v; `none` for rates of cut joints.
  std::uint32_t number(std::uint32_t rate) const { return number_[rate]; }

  /// The rate before this one; `none` at the ground.
  std::uint32_t parent(std::uint32_t p) const { return parent_[p]; }
  std::uint32_t depth(std::uint32_t p) const { return depth_[p]; }        ///< the number of ancestors, itself included
  std::uint32_t first_entry(std::uint32_t p) const { return first_[p]; }  ///< of its row among all entries
  /// The ancestors of a rate, itself included, from the ground outwards.
  std::span<const Run> ancestors(std::uint32_t p) const { return {runs_.data() + first_run_[p], run_count_[p]}; }

 private:
  void add_rates(const TreeStep& step, std::uint32_t parent_rate);
  void add_runs(std::uint32_t p);

  const Mechanism* mechanism_;
  std::vector<Step> steps_;
  std::vector<std::uint32_t> rate_, number_, parent_, depth_, first_, first_run_, run_count_;
  std::vector<Run> runs_;
  std::uint32_t entries_ = 0;
};

}  // namespace koppel
