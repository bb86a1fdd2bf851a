#include "closure/modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "closure/flow_solver.hpp"
#include "closure/newton.hpp"

namespace koppel {
namespace {

constexpr double spurious = 1e-5;    // a solution of the steps that leaves more open than this is none of the loops
constexpr double moved_most = 1e-3;  // by Newton's method from a solution of the steps, in radians' size
constexpr double same = 1e-7;        // modes nearer than this are one

/// Greatest component of the way from one position to another, in radians' size.
double distance(const Mechanism& mechanism, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                Eigen::VectorXd& delta) {
  difference(mechanism, from, to, delta);
  double most = 0.0;
  for (const StateBlock& block : mechanism.blocks) {
    const std::size_t rates = rate_count(block.kind);
    for (std::size_t i = 0; i < rates; ++i) {
      double d = delta[static_cast<Eigen::Index>(block.v + i)];
      if (block.kind == BlockKind::angle) d = std::remainder(d, 2.0 * std::numbers::pi);
      most = std::max(most, std::abs(d) / mechanism.rate_scale[block.v + i]);
    }
  }
  return most;
}

class Search {
 public:
  Search(Work& work, const State& state, const ModeOptions& options, const Flow& flow, Modes& modes)
      : work_(work), state_(state), options_(options), flow_(flow), modes_(modes), solver_(flow, continuation()) {}

  bool stopped() const { return stopped_; }

  /// False: a plugin failed.
  bool run() {
    modes_.complete = true;
    modes_.held = flow_.held.size();
    if (flow_.doubtful) uncertain("axes that are taken for parallel or meeting are so only nearly");
    const auto nq = static_cast<Eigen::Index>(work_.mechanism->nq);
    // Imaginary joints start where nothing has moved.
    Eigen::VectorXd q = Eigen::VectorXd::Zero(nq + 7 * static_cast<Eigen::Index>(flow_.loops.imaginary.size()));
    q.head(nq) = state_.q;
    for (Eigen::Index at = nq; at < q.size(); at += 7) q[at + 3] = 1.0;
    for (std::size_t i = 0; i < work_.mechanism->inputs.size(); ++i) {
      q[work_.mechanism->inputs[i].q] = state_.input[static_cast<Eigen::Index>(i)];
    }
    count_twins();
    descend(0, q, "", 0.0, 1.0);
    explain();
    return !plugin_failed_;
  }

 private:
  ContinuationOptions continuation() {
    ContinuationOptions options;
    options.progress = [this](const ContinuationProgress&) {
      return !options_.progress || options_.progress(modes_.modes.size(), part_);
    };
    return options;
  }

  void count_twins() {
    const auto pairs =
        std::count_if(flow_.steps.begin(), flow_.steps.end(), [](const auto& step) { return step.twins; });
    list_twins_ = options_.all_twins || pairs < 2;
    if (!list_twins_) modes_.twins = std::size_t{1} << std::min<std::ptrdiff_t>(pairs, 62);
  }

  void descend(std::size_t number, const Eigen::VectorXd& q, const std::string& id, double from, double width) {
    if (stopped_ || plugin_failed_) return;
    if (number == flow_.steps.size()) {
      if (loops_close(q)) take(q.head(work_.mechanism->nq), id);
      part_ = from + width;
      if (modes_.modes.size() >= options_.most)
        stop("the search was ended at " + std::to_string(options_.most) + " modes");
      if (options_.progress && !options_.progress(modes_.modes.size(), part_)) stop("the search was stopped");
      return;
    }
    if (++steps_ > options_.most_steps) {
      stop("the search was ended after " + std::to_string(options_.most_steps) + " steps of the flow");
      return;
    }
    const FlowStep& step = flow_.steps[number];
    StepSolutions found = solver_.solve(step, q);
    if (!found.complete) uncertain(found.why);
    if (found.undetermined && step.kind != StepKind::spin) {
      uncertain("somewhere a coordinate does not matter and was left as it is");
    }
    if (known_by_.empty()) known_by_ = found.why;
    if (found.positions.empty() && found.missed_by) modes_.missed_by.push_back(*found.missed_by);
    if (step.twins && !list_twins_ && found.positions.size() > 1) keep_nearest(step, q, found.positions);
    const std::size_t count = found.positions.size();
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (options_.nearest_first && count > 1) {
      std::vector<double> far;
      for (const Eigen::VectorXd& position : found.positions) {
        far.push_back(distance(*work_.mechanism, q, position, work_.delta));
      }
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return far[a] < far[b]; });
    }
    const double share = width / static_cast<double>(std::max<std::size_t>(count, 1));
    double done = from;
    for (const std::size_t i : order) {
      std::string longer = id;
      if (count > 1 || could_be_several(step)) {
        if (!id.empty()) longer += '.';
        longer += std::to_string(i + 1);
      }
      descend(number + 1, found.positions[i], longer, done, share);
      done += share;
    }
  }

  bool could_be_several(const FlowStep& step) const {
    return step.kind == StepKind::two_unknowns || step.kind == StepKind::numerical;
  }

  void keep_nearest(const FlowStep& step, const Eigen::VectorXd& q, std::vector<Eigen::VectorXd>& positions) const {
    const std::uint32_t at = flow_.loops.variables[step.unknowns[0]].q;
    std::nth_element(positions.begin(), positions.begin(), positions.end(),
                     [&](const auto& a, const auto& b) { return std::abs(a[at] - q[at]) < std::abs(b[at] - q[at]); });
    positions.resize(1);
  }

  /// All loops, with the coordinates of all their joints. The equations of closure leave out those of the joints that
  /// are cut.
  bool loops_close(const Eigen::VectorXd& q) const {
    const auto at = places(flow_.loops.variables, q.data());
    return std::all_of(flow_.loops.loops.begin(), flow_.loops.loops.end(), [&](const Loop& loop) {
      const Pose round = walk<double>(round_way(loop, flow_.loops.variables), at);
      return (round.rotation - Matrix3::Identity()).norm() < spurious &&
             round.position.norm() < spurious * flow_.length;
    });
  }

  /// Checks a position by the equations of closure and takes it to rounding.
  void take(const Eigen::VectorXd& q, const std::string& id) {
    work_.factorised = false;
    work_.q = q;
    const NewtonResult result = newton(work_, state_.time, {});
    plugin_failed_ = result.plugin_failed;
    if (!result.converged || distance(*work_.mechanism, q, work_.q, work_.delta) > moved_most) {
      uncertain("a position closes nearly, but not to rounding");
      return;
    }
    if (!work_.equations.cut_coordinates(work_.q)) {
      plugin_failed_ = true;
      return;
    }
    for (Mode& known : modes_.modes) {
      if (distance(*work_.mechanism, known.q, work_.q, work_.delta) > same) continue;
      known.limit = true;
      return;
    }
    modes_.modes.push_back({id.empty() ? "1" : id, work_.q, work_.equations.error(), false});
  }

  void stop(const std::string& why) {
    stopped_ = true;
    uncertain_by_.clear();
    uncertain(why);
  }

  /// There may be others; the first reason is told.
  void uncertain(const std::string& why) {
    modes_.complete = false;
    if (uncertain_by_.empty()) uncertain_by_ = why;
  }

  void explain() {
    if (!modes_.complete) {
      modes_.why = uncertain_by_;
    } else if (flow_.loops.loops.empty()) {
      modes_.why = "there are no loops to close";
    } else {
      modes_.why = known_by_.empty() ? "every step of the flow is solved in closed form" : known_by_;
    }
    if (modes_.held > 0) modes_.why += "; what no input determines was taken as it is";
  }

  Work& work_;
  const State& state_;
  const ModeOptions& options_;
  const Flow& flow_;
  Modes& modes_;
  FlowSolver solver_;
  bool list_twins_ = true;
  bool plugin_failed_ = false, stopped_ = false;
  double part_ = 0.0;
  std::size_t steps_ = 0;
  std::string known_by_, uncertain_by_;
};

/// The last resort: Newton's method from random starts, ever further away.
bool restart(Work& work, const State& state, const ModeOptions& options, Modes& modes) {
  const Mechanism& mechanism = *work.mechanism;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  for (std::size_t i = 0; i < options.restarts && modes.modes.size() < options.most; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(options.restarts);
    if (options.progress && !options.progress(modes.modes.size(), part)) break;
    for (Eigen::Index k = 0; k < work.delta.size(); ++k) {
      work.delta[k] = std::numbers::pi * part * between(random) * mechanism.rate_scale[static_cast<std::size_t>(k)];
    }
    integrate(mechanism, state.q, work.delta, work.q);
    for (std::size_t k = 0; k < mechanism.inputs.size(); ++k) {
      work.q[mechanism.inputs[k].q] = state.input[static_cast<Eigen::Index>(k)];
    }
    const NewtonResult result = newton(work, state.time, {});
    // A plugin need not have an answer everywhere.
    if (result.plugin_failed || !result.converged) continue;
    if (!work.equations.cut_coordinates(work.q)) return false;
    const bool known = std::any_of(modes.modes.begin(), modes.modes.end(), [&](const Mode& mode) {
      return distance(mechanism, mode.q, work.q, work.delta) <= same;
    });
    if (known) continue;
    modes.modes.push_back({std::to_string(modes.modes.size() + 1), work.q, work.equations.error(), false});
  }
  modes.why += ": only what Newton's method found from " + std::to_string(options.restarts) + " random starts";
  return true;
}

}  // namespace

bool find_modes(Work& work, const State& state, const ModeOptions& options, Modes& modes) {
  modes = Modes{};
  const Flow flow = plan_flow(*work.mechanism);
  if (!flow.obstacle.empty()) {
    modes.why = flow.obstacle;
    return restart(work, state, options, modes);
  }
  Search search(work, state, options, flow, modes);
  if (!search.run()) return false;
  if (!modes.modes.empty() || modes.complete || search.stopped()) return true;
  return restart(work, state, options, modes);
}

}  // namespace koppel
