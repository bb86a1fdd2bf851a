// How a flow is planned: step by step, always the least block of unknowns that what is known determines.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <tuple>
#include <vector>

#include "closure/flow.hpp"

namespace koppel {

/// Adds a value to an ascending list, once.
template <typename T>
inline void insert_sorted(std::vector<T>& into, const T& value) {
  const auto at = std::lower_bound(into.begin(), into.end(), value);
  if (at == into.end() || *at != value) into.insert(at, value);
}

/// A cut of a loop with what enters its conditions.
struct PlannedCut {
  LoopCut cut;
  std::vector<std::vector<std::uint32_t>> enters;  ///< of each condition: the variables that change it, ascending
  /// Whether something unknown changes it where the loop is closed. One that only changes elsewhere has a double root
  /// there: it tells solutions from others, but finds none.
  std::vector<bool> tells;
  bool mirror = false;
};

class FlowPlan {
 public:
  /// Plans into `flow`, which has loops, length and inputs.
  explicit FlowPlan(Flow& flow);
  void run();

 private:
  using Variables = std::vector<std::uint32_t>;

  Variables unknown_in(std::uint32_t loop) const;
  Variables unknown_of(const Variables& variables) const;
  int freedoms(const Variables& variables) const;
  bool shared(std::uint32_t variable, std::uint32_t loop) const;
  void learn(const Variables& variables);
  void refresh(std::uint32_t loop);
  PlannedCut planned(std::uint32_t loop, const CutJoint& a, const std::optional<CutJoint>& b);
  std::vector<CutJoint> cut_joints(std::uint32_t loop) const;
  std::span<const Place<double>> shuffled(std::uint32_t loop);
  Loop closed(std::uint32_t loop, std::span<const Place<double>> at) const;
  enum class Positions { any, closed };
  std::vector<std::vector<std::uint32_t>> entering(const LoopCut& cut, Positions positions);

  int conditions_of(std::uint32_t loop);
  int rank_of_loop(std::uint32_t loop);
  struct LoopCondition {
    const LoopCut* cut;
    std::size_t condition;
  };
  template <typename Function>
  void for_each_rate(const LoopCut& cut, const Loop& loop, std::span<const Place<double>> at, const Function& f) const;
  std::size_t rank_of(const LoopCut& cut, const Variables& by);
  int hidden_shared(std::uint32_t loop, const LoopCut& cut) const;
  bool independent(std::span<const LoopCondition> conditions, const Variables& by);
  /// What a loop adds to a numerical block.
  struct Share {
    std::uint32_t loop = 0;
    std::optional<std::size_t> cut;  ///< in cuts_ of the loop; nothing: the loop as a whole
    Variables core;
    std::size_t rows = 0;
  };
  Share share_of(std::uint32_t loop);
  bool leaves_cross(std::uint32_t loop, const LoopCut& cut) const;

  bool read_joint(std::uint32_t loop);
  bool take_one();
  bool take_two();
  bool take_spin();
  bool take_block();
  void hold_one();
  void give(FlowStep& step, const Variables& variables) const;
  void give_known(FlowStep& step, std::uint32_t loop) const;
  void take_row(FlowStep& step, const PlannedCut& cut, std::uint32_t number, std::size_t condition) const;
  void add(FlowStep step);
  std::uint32_t number_of(const LoopCut& cut);
  void mark_only_here();

  /// A step with one unknown, and what speaks for and against it.
  struct Candidate {
    std::tuple<bool, int, int, bool, std::size_t> cost;
    std::uint32_t unknown = 0;
    std::size_t cut = 0;  ///< in cuts_ of its loop
  };
  /// A condition with two unknowns: point-line conditions, mirror images and shared joints speak against it.
  struct PairRow {
    std::array<int, 3> cost{};
    std::uint32_t loop = 0;
    std::size_t cut = 0, condition = 0;
  };
  std::map<Variables, std::vector<PairRow>> rows_of_pairs() const;
  std::optional<Candidate> best_single(std::uint32_t loop) const;

  Flow& flow_;
  std::mt19937_64 random_{20240229};
  std::vector<Place<double>> places_;  ///< random ones, of each variable
  std::vector<bool> known_;
  std::vector<std::vector<std::uint32_t>> loops_of_;    ///< of each variable
  std::vector<bool> done_;                              ///< loops without unknowns
  std::vector<bool> touched_;                           ///< loops of which more is known than when last looked at
  std::vector<bool> stale_;                             ///< loops whose cuts must be found anew
  std::vector<bool> recovering_;                        ///< loops that are closed but for their cut joints' coordinates
  std::vector<std::optional<std::uint32_t>> used_cut_;  ///< of each loop, the last that a step used
  std::vector<bool> steps_of_recovery_;                 ///< of each step: all its loops were closed before
  std::vector<std::vector<PlannedCut>> cuts_;           ///< of each loop, for its present unknowns
};

}  // namespace koppel
