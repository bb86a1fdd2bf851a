// What the parts of a solution flow are called, in texts and in drawings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "closure/flow.hpp"
#include "mechanism/mechanism.hpp"

namespace koppel {

/// "crank"; of an imaginary joint "[ground to platform]".
std::string joint_name(const Mechanism& mechanism, const Flow& flow, JointId joint);
std::vector<std::string> joint_names(const Mechanism& mechanism, const Flow& flow, const std::vector<JointId>& joints);

/// "crank.angle"; of a ball "ball.rotation".
std::string variable_name(const Mechanism& mechanism, const Flow& flow, std::uint32_t variable);
std::vector<std::string> variable_names(const Mechanism& mechanism, const Flow& flow,
                                        const std::vector<std::uint32_t>& variables);

/// "S-T", "R": the joints at which a loop is cut, by their letters. Runs of parallel turns and of slides that leave
/// less than a plane are named by what they consist of: "RR", "RP".
std::string cut_letters(const Flow& flow, const LoopCut& cut);
/// The joints of the scene in either cut joint: "ball", "crank + pin".
std::vector<std::string> cut_names(const Mechanism& mechanism, const Flow& flow, const LoopCut& cut);

/// "distance of two points"
std::string type_name(ClosureType type);
/// "type 1", "types 2 and 4" of the conditions of a step, ascending, each once.
std::string type_numbers(const Flow& flow, const FlowStep& step);

/// How a step is solved: "closed form, at most 2 solutions (type 1)", "read off joint pin", ...
std::string solver_words(const Mechanism& mechanism, const Flow& flow, const FlowStep& step);

/// "loop 2", "loops 1, 2, 3", counted from 1.
std::string loop_words(const std::vector<std::uint32_t>& loops);

/// Unknown numbers in a step; those of a ball count as its three freedoms.
std::size_t unknowns_in(const Flow& flow, const FlowStep& step);

/// "a, b, c"
std::string listed(const std::vector<std::string>& words);

}  // namespace koppel
