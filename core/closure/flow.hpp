// The solution flow: in which order the coordinates of a mechanism follow from its inputs, and how each does - in
// closed form wherever one condition, or two, determine one unknown or two; together and numerically where not
// (K-II-4.2.3).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "closure/loop.hpp"
#include "closure/loop_cut.hpp"

namespace koppel {

enum class StepKind {
  one_unknown,   ///< from conditions that nothing else unknown enters (K-II-3.4.4): closed form, all solutions
  two_unknowns,  ///< from two conditions by elimination: all solutions
  joint,         ///< read off the pose between the two frames of a joint, when all else in a loop is known
  spin,          ///< a link between two balls: nothing determines how it is turned about their line; it is turned least
  numerical      ///< more unknowns together
};

/// A condition of a cut loop.
struct FlowRow {
  std::uint32_t cut = 0, condition = 0;
  std::vector<std::uint32_t> variables;  ///< that enter it, ascending
};

struct FlowStep {
  StepKind kind = StepKind::one_unknown;
  std::vector<std::uint32_t> unknowns;     ///< variables, ascending
  std::vector<std::uint32_t> given;        ///< variables that must be known before, ascending
  std::vector<FlowRow> rows;               ///< its conditions; of `joint` and `spin` none
  std::uint32_t cut = 0;                   ///< of `joint` (a: the joint) and `spin` (a, b: the balls)
  std::vector<std::uint32_t> whole_loops;  ///< of `numerical`: loops that enter with all conditions that close them
  std::vector<std::uint32_t> loops;        ///< all loops that it closes, or helps to
  bool only_here = false;                  ///< no other loop needs what it gives: computed if somebody asks
  /// Of `one_unknown`: its two solutions differ by half a turn of a link about the line between a ball and a Cardan
  /// joint, which no other body notices.
  bool twins = false;
};

struct Flow {
  Loops loops;
  double length = 1.0;                 ///< of the mechanism [m]
  std::vector<std::uint32_t> inputs;   ///< driven variables
  std::vector<std::uint32_t> held;     ///< free ones that are taken as they are: nothing determines them
  std::vector<std::uint32_t> outside;  ///< variables of joints that are in no loop
  std::vector<LoopCut> cuts;
  std::vector<FlowStep> steps;
  /// Axes that are taken for parallel or meeting are so only to half the digits: a solution may have been overlooked.
  bool doubtful = false;
  std::string obstacle;  ///< why there is no flow; empty if there is one

  bool in_closed_form() const;
};

/// Plans the flow for the mechanism's inputs. Only the mechanism's measures enter, not its position: conditions that
/// are always met (those of planar and spherical loops) are told by their derivatives at random positions. Where
/// unknowns remain that must be solved together, other independent loops are tried - those that share one joint, or the
/// pose of a body as auxiliary coordinates - and the ones that leave the least to solve are taken (K-II-4.2.2, 4.3.2).
enum class FlowChoice {
  best,
  first  ///< the loops of least size alone, which is soon done
};
Flow plan_flow(const Mechanism& mechanism, FlowChoice choice = FlowChoice::best);

}  // namespace koppel
