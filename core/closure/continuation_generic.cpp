#include "closure/continuation_generic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace koppel {
namespace {

constexpr Eigen::Index untried = -1, failed = -2;
constexpr double tighter = 0.1;  // for what has jumped
constexpr double solved = 1e-9;  // last Newton step of a generic solution
constexpr double same = 1e-7;    // generic solutions nearer than that would have conditions above 1e7
constexpr int seed_trials = 20;
constexpr Eigen::Index most_jumps = 1000;  // mended; beyond that they count as failed
constexpr std::int64_t most_idle_edges = 20;
constexpr double least_height = 0.2, most_height = 20.0, largest_log = 0.5;  // of arcs, in units of their span

double largest(const ComplexVector& x) { return x.size() == 0 ? 0.0 : std::sqrt(x.cwiseAbs2().maxCoeff()); }

/// Uniform on [0, 1), the same with every standard library.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

/// w of an arc whose greatest distance from the straight line is log-uniform: branch points may be far away, and what
/// joins the largest solutions with the others often is. (Heights up to 5 missed some of 40 in 9 % of Stewart
/// platforms.)
Complex random_bend(std::mt19937_64& random) {
  const double side = uniform(random) < 0.5 ? -1.0 : 1.0;
  const double height = least_height * std::pow(most_height / least_height, uniform(random));
  return std::polar(std::exp(largest_log * (2.0 * uniform(random) - 1.0)), side * 2.0 * std::atan(2.0 * height));
}

}  // namespace

double SolutionSet::key(const ComplexVector& print, double& weight) {
  double sum = 0.0, w = 1.0;
  weight = 0.0;
  for (const Complex& value : print) {
    sum += w * value.real() + (1.5 - w) * value.imag();
    weight += 1.5;
    w = std::fmod(w + std::numbers::phi, 1.5);  // no symmetry of the prints may make keys equal
  }
  return sum;
}

Eigen::Index SolutionSet::find(const ComplexVector& print, double tolerance) const {
  double weight = 0.0;
  const double wanted = key(print, weight), bound = tolerance * std::max(1.0, largest(print));
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (std::abs(keys_[i] - wanted) > bound * weight) continue;
    if ((prints[i] - print).cwiseAbs2().maxCoeff() <= bound * bound) return static_cast<Eigen::Index>(i);
  }
  return -1;
}

void SolutionSet::add(const ComplexVector& point, const ComplexVector& print) {
  double weight = 0.0;
  points.push_back(point);
  prints.push_back(print);
  keys_.push_back(key(print, weight));
}

MonodromyGraph::MonodromyGraph(ContinuationProblem& problem, const ContinuationOptions& options)
    : problem_(problem), options_(options), tracker_(problem), random_(options.random_seed) {
  x_.setZero(problem.point_size());
  p_.setZero(problem.parameters());
}

bool MonodromyGraph::draw_seed(ComplexVector& x, ComplexVector& p) {
  for (int i = 0; i < seed_trials; ++i) {
    if (!problem_.seed(random_, x, p)) return false;
    if (tracker_.refine(p, x) <= solved) return true;
  }
  return false;
}

void MonodromyGraph::add_edge() {
  Edge edge;
  // First round all nodes, then between those two apart, and so on; then again along other arcs.
  const std::size_t n = nodes_.size(), pair = edges_.size() % (n * (n - 1) / 2);
  edge.nodes = {pair % n, (pair + 1 + pair / n) % n};
  edge.w = random_bend(random_);
  edges_.push_back(std::move(edge));
}

Route MonodromyGraph::route(const Edge& edge, std::size_t side) const {
  // The same arc backwards has 1 / w.
  return {&nodes_[edge.nodes[side]].p, &nodes_[edge.nodes[1 - side]].p, side == 0 ? edge.w : 1.0 / edge.w};
}

/// Index of the solution of node `to` where the path ends, which may be a new one; failed.
Eigen::Index MonodromyGraph::follow(const Route& route, std::size_t to, const ComplexVector& start, double tightness) {
  StepBounds bounds = StepBounds{}.tightened(options_.tightness * tightness);
  bounds.steps = options_.max_steps;
  double t = 0.0;
  x_ = start;
  if (tracker_.follow(route, t, 1.0, x_, bounds) != Tracker::Outcome::arrived) return failed;
  if (!(tracker_.refine(nodes_[to].p, x_) <= solved)) return failed;
  problem_.fingerprint(x_, print_);
  SolutionSet& solutions = nodes_[to].solutions;
  Eigen::Index index = solutions.find(print_, same);
  if (index < 0) {
    index = solutions.size();
    solutions.add(x_, print_);
    grown_ = true;
  }
  return index;
}

/// Two different solutions of one end have met at the other: one path has jumped. Both anew, with shorter steps.
void MonodromyGraph::mend(Edge& edge, std::size_t side, Eigen::Index i, Eigen::Index other) {
  ++result_.jumps;
  const auto at = [](std::vector<Eigen::Index>& list, Eigen::Index k) -> Eigen::Index& {
    if (static_cast<std::size_t>(k) >= list.size()) list.resize(static_cast<std::size_t>(k) + 1, untried);
    return list[static_cast<std::size_t>(k)];
  };
  std::vector<Eigen::Index>& back = edge.image[1 - side];
  Eigen::Index ends[2] = {failed, failed};
  const Eigen::Index starts[2] = {i, other};
  for (std::size_t k = 0; k < 2; ++k) {
    const ComplexVector& start = nodes_[edge.nodes[side]].solutions.points[static_cast<std::size_t>(starts[k])];
    std::replace(back.begin(), back.end(), starts[k], untried);
    ends[k] = follow(route(edge, side), edge.nodes[1 - side], start, tighter);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const bool taken = ends[k] >= 0 && (ends[0] == ends[1] || at(back, ends[k]) >= 0);
    if (ends[k] < 0 || taken) {
      ++result_.failed;
      at(edge.image[side], starts[k]) = failed;
    } else {
      at(edge.image[side], starts[k]) = ends[k];
      at(back, ends[k]) = starts[k];
    }
  }
}

void MonodromyGraph::follow_edge(Edge& edge, std::size_t side, Eigen::Index i) {
  const ComplexVector& start = nodes_[edge.nodes[side]].solutions.points[static_cast<std::size_t>(i)];
  const Eigen::Index end = follow(route(edge, side), edge.nodes[1 - side], start, 1.0);
  std::vector<Eigen::Index>& there = edge.image[side];
  std::vector<Eigen::Index>& back = edge.image[1 - side];
  there[static_cast<std::size_t>(i)] = end;
  if (end == failed) {
    ++result_.failed;
    return;
  }
  if (static_cast<std::size_t>(end) >= back.size()) back.resize(static_cast<std::size_t>(end) + 1, untried);
  const Eigen::Index other = back[static_cast<std::size_t>(end)];
  if (other >= 0 && other != i && result_.jumps >= most_jumps) {
    there[static_cast<std::size_t>(i)] = failed;
    ++result_.failed;
  } else if (other >= 0 && other != i) {
    mend(edge, side, i, other);
  } else {
    back[static_cast<std::size_t>(end)] = i;
  }
}

/// Follows what has not been followed, on all edges and until nothing is left: found solutions set off at once.
void MonodromyGraph::sweep() {
  for (bool idle = false; !idle;) {
    idle = true;
    for (Edge& edge : edges_) {
      for (std::size_t side = 0; side < 2; ++side) {
        std::vector<Eigen::Index>& image = edge.image[side];
        const SolutionSet& from = nodes_[edge.nodes[side]].solutions;
        for (Eigen::Index i = 0; i < from.size(); ++i) {
          if (static_cast<std::size_t>(i) >= image.size()) image.resize(static_cast<std::size_t>(i) + 1, untried);
          if (image[static_cast<std::size_t>(i)] != untried) continue;
          idle = false;
          follow_edge(edge, side, i);
          if (!report() || enough()) return;
        }
      }
    }
  }
}

/// Fresh seeds, carried to the first node.
void MonodromyGraph::check_seeds() {
  for (int i = 0; i < options_.idle_seeds && !grown_; ++i) {
    ComplexVector x = x_, p = p_;
    if (!draw_seed(x, p)) return;
    const Route way{&p, &nodes_[0].p, random_bend(random_)};
    if (follow(way, 0, x, 1.0) == failed) ++result_.failed;
    if (!report()) return;
  }
}

std::size_t MonodromyGraph::fullest() const {
  std::size_t best = 0;
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    if (nodes_[i].solutions.size() > nodes_[best].solutions.size()) best = i;
  }
  return best;
}

/// Tells the caller. False: stop.
bool MonodromyGraph::report() {
  const Eigen::Index most = nodes_[fullest()].solutions.size();
  result_.stopped =
      most > options_.max_solutions ||
      (options_.progress && !options_.progress({ContinuationProgress::Phase::generic,
                                                static_cast<Eigen::Index>(tracker_.cost.paths), 0, most}));
  return !result_.stopped;
}

bool MonodromyGraph::enough() const {
  return options_.known_count > 0 && nodes_[fullest()].solutions.size() >= options_.known_count;
}

/// Whether another node holds as much as the fullest one. One with less has lost paths, as where a solution is huge.
bool MonodromyGraph::equally_full() const {
  const Eigen::Index most = nodes_[fullest()].solutions.size();
  return std::count_if(nodes_.begin(), nodes_.end(),
                       [most](const Node& node) { return node.solutions.size() == most; }) > 1;
}

GenericSolutions MonodromyGraph::run() {
  const int nodes = std::max(2, options_.nodes);
  for (int i = 0; i < nodes; ++i) {
    Node node;
    node.p = p_;
    if (!draw_seed(x_, node.p)) return result_;
    problem_.fingerprint(x_, print_);
    node.solutions.add(x_, print_);
    nodes_.push_back(std::move(node));
  }
  result_.seeded = true;
  for (std::size_t i = 0; i < nodes_.size(); ++i) add_edge();
  std::int64_t idle_edges = 0, idle_paths = 0;
  while (!result_.stopped) {
    grown_ = false;
    sweep();
    if (result_.stopped) break;
    const Eigen::Index count = nodes_[fullest()].solutions.size();
    idle_edges = grown_ ? 0 : idle_edges + 1;
    idle_paths = grown_ ? 0 : idle_paths + count;
    result_.settled = enough();
    if (result_.settled) break;
    const bool idle =
        idle_edges >= options_.idle_edges && (idle_paths >= options_.idle_paths || idle_edges >= most_idle_edges);
    if (idle && equally_full()) {
      grown_ = false;
      check_seeds();
      if (result_.stopped) break;
      result_.settled = !grown_;
      if (result_.settled) break;
      idle_edges = idle_paths = 0;
      continue;
    }
    if (edges_.size() >= static_cast<std::size_t>(std::max(0, options_.max_edges))) break;
    add_edge();
  }
  const Eigen::Index most = nodes_[fullest()].solutions.size();
  for (Node& node : nodes_) {
    if (node.solutions.size() == most) result_.nodes.push_back({node.p, std::move(node.solutions.points)});
  }
  result_.edges = static_cast<Eigen::Index>(edges_.size());
  result_.cost = tracker_.cost;
  return std::move(result_);
}

}  // namespace koppel
