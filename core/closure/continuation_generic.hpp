// The graph of generic parameters whose edges carry solutions round loops (see continuation.hpp).
#pragma once

#include <array>
#include <random>
#include <vector>

#include "closure/continuation_path.hpp"

namespace koppel {

/// Points told apart by their prints.
class SolutionSet {
 public:
  /// Index of the solution whose print differs by no more than tolerance max(1, greatest entry); -1: none.
  Eigen::Index find(const ComplexVector& print, double tolerance) const;
  void add(const ComplexVector& point, const ComplexVector& print);
  Eigen::Index size() const { return static_cast<Eigen::Index>(points.size()); }

  std::vector<ComplexVector> points, prints;

 private:
  static double key(const ComplexVector& print, double& weight);
  std::vector<double> keys_;  ///< a combination of each print's numbers: comparing it first is fast
};

/// Serves one run. Nodes are seeds' parameters, and start with the seed's solution.
class MonodromyGraph {
 public:
  MonodromyGraph(ContinuationProblem& problem, const ContinuationOptions& options);
  GenericSolutions run();

 private:
  struct Node {
    ComplexVector p;
    SolutionSet solutions;
  };
  struct Edge {
    std::array<std::size_t, 2> nodes;
    Complex w;                                       ///< of the route from the first node to the second
    std::array<std::vector<Eigen::Index>, 2> image;  ///< of each end's solutions at the other end, or `untried`, ...
  };

  bool draw_seed(ComplexVector& x, ComplexVector& p);
  void add_edge();
  Route route(const Edge& edge, std::size_t side) const;
  Eigen::Index follow(const Route& route, std::size_t to, const ComplexVector& start, double tightness);
  void follow_edge(Edge& edge, std::size_t side, Eigen::Index i);
  void mend(Edge& edge, std::size_t side, Eigen::Index i, Eigen::Index other);
  void sweep();
  void check_seeds();
  bool report();
  bool enough() const;
  bool equally_full() const;
  std::size_t fullest() const;

  ContinuationProblem& problem_;
  const ContinuationOptions& options_;
  Tracker tracker_;
  std::mt19937_64 random_;
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  GenericSolutions result_;
  ComplexVector x_, p_, print_;
  bool grown_ = false;
};

}  // namespace koppel
