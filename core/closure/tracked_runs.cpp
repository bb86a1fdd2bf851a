// Which motions several ways have in common.
#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "closure/tracked_way.hpp"

namespace koppel {
namespace {

using Pieces = std::span<const Piece>;

/// The motions of a run passed backwards, but for what turns its ends round.
std::vector<Piece> backwards(Pieces run) {
  std::vector<Piece> result(run.rbegin(), run.rend());
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (result[i].kind == Piece::Kind::ball) result[i].inverse = !result[i].inverse;
    if (i == 0) continue;
    const Pose& between = run[run.size() - i].to;
    result[i].to = turning_round(result[i - 1].kind) * between.inverse() * turning_round(result[i].kind);
  }
  result.front().to = Pose{};
  return result;
}

/// Whether motions are those of a run, whatever stands before them.
bool same_motions(Pieces a, Pieces run) {
  // Both follow from the same joints, by walks that differ in the order of their roundings.
  constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
  if (a.size() != run.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].kind != run[i].kind || a[i].index != run[i].index || a[i].inverse != run[i].inverse) return false;
    if (i == 0) continue;
    const double far = 1.0 + run[i].to.position.norm();
    if ((a[i].to.rotation - run[i].to.rotation).lpNorm<Eigen::Infinity>() > rounding) return false;
    if ((a[i].to.position - run[i].to.position).lpNorm<Eigen::Infinity>() > rounding * far) return false;
  }
  return true;
}

/// Motions that a way passes one after the other, all of them solved for in its step, or none.
struct Stretch {
  const WayOfStep* of = nullptr;
  std::size_t first = 0, count = 0;
  bool unknown = false;

  Pieces pieces() const { return Pieces(of->way->pieces).subspan(first, count); }
};

std::vector<Stretch> stretches_of(const WayOfStep& of) {
  std::vector<Stretch> result;
  for (std::size_t i = 0; i < of.way->pieces.size(); ++i) {
    const auto& unknowns = of.unknowns;
    const bool unknown = std::find(unknowns.begin(), unknowns.end(), of.way->pieces[i].index) != unknowns.end();
    if (result.empty() || result.back().unknown != unknown) result.push_back({&of, i, 0, unknown});
    ++result.back().count;
  }
  return result;
}

class Sharing {
 public:
  void count(const Stretch& stretch);
  void choose();
  void replace(const Stretch& stretch);
  std::vector<Run> runs;

 private:
  struct Candidate {
    std::vector<Piece> motions;
    int walks = 0;
  };
  struct Found {
    std::uint32_t run = 0;
    bool inverse = false;
    std::size_t count = 0;
  };
  std::optional<Found> longest(Pieces pieces) const;
  std::size_t pieces_left(Pieces pieces) const;

  std::map<std::vector<std::uint32_t>, std::vector<Candidate>> candidates_;  ///< by their variables
  std::multimap<std::uint32_t, Found> by_end_;                               ///< runs, by the variable passed first
};

/// In the direction that begins with the lesser variable.
void Sharing::count(const Stretch& stretch) {
  const Pieces there = stretch.pieces();
  const std::vector<Piece> back = backwards(there);
  const Pieces motions = there.front().index < there.back().index ? there : Pieces(back);
  std::vector<std::uint32_t> variables;
  for (const Piece& piece : motions) variables.push_back(piece.index);
  auto& candidates = candidates_[variables];
  const auto same = [&](const Candidate& c) { return same_motions(motions, c.motions); };
  auto candidate = std::find_if(candidates.begin(), candidates.end(), same);
  if (candidate == candidates.end()) {
    candidate = candidates.insert(candidates.end(), {{motions.begin(), motions.end()}, 0});
    candidate->motions.front().to = Pose{};
  }
  candidate->walks += stretch.of->walks;
}

/// The longest run that begins where the pieces do.
std::optional<Sharing::Found> Sharing::longest(Pieces pieces) const {
  std::optional<Found> result;
  const auto [first, last] = by_end_.equal_range(pieces.front().index);
  for (auto found = first; found != last; ++found) {
    const auto& [run, inverse, count] = found->second;
    if (count > pieces.size() || (result && result->count >= count)) continue;
    const Pieces part = pieces.first(count);
    const std::vector<Piece>& motions = runs[run].way.pieces;
    if (inverse ? same_motions(part, backwards(motions)) : same_motions(part, motions)) result = found->second;
  }
  return result;
}

/// How many there are when runs stand for what they hold.
std::size_t Sharing::pieces_left(Pieces pieces) const {
  std::size_t result = 0;
  while (!pieces.empty()) {
    const auto found = longest(pieces);
    pieces = pieces.subspan(found ? found->count : 1);
    ++result;
  }
  return result;
}

/// Those whose own computation costs less than they save: the shortest first, as longer ones may hold them.
void Sharing::choose() {
  std::vector<Candidate*> all;
  for (auto& [variables, candidates] : candidates_) {
    for (Candidate& candidate : candidates) all.push_back(&candidate);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate* a, const Candidate* b) { return a->motions.size() < b->motions.size(); });
  for (Candidate* candidate : all) {
    const std::size_t size = candidate->motions.size();
    const auto saved = static_cast<std::size_t>(candidate->walks) * (pieces_left(candidate->motions) - 1);
    if (saved <= 2 * size) continue;
    const auto number = static_cast<std::uint32_t>(runs.size());
    by_end_.insert({candidate->motions.front().index, {number, false, size}});
    by_end_.insert({candidate->motions.back().index, {number, true, size}});
    Run run;
    run.way.pieces = std::move(candidate->motions);
    run.way.frames.resize(size);
    run.screws.reserve(3 * size);
    runs.push_back(std::move(run));
  }
}

void Sharing::replace(const Stretch& stretch) {
  TrackedWay& way = *stretch.of->way;
  std::vector<Piece> replaced(way.pieces.begin(), way.pieces.begin() + static_cast<std::ptrdiff_t>(stretch.first));
  Pieces left = stretch.pieces();
  Pose before;  // what a run leaves to what comes behind it
  while (!left.empty()) {
    Piece piece = left.front();
    piece.to = before * piece.to;
    before = Pose{};
    std::size_t count = 1;
    if (const auto found = longest(left)) {
      count = found->count;
      piece = {Piece::Kind::run, found->inverse, found->run, piece.to};
      if (found->inverse) {
        piece.to = piece.to * turning_round(left.front().kind);
        before = turning_round(left[count - 1].kind);
      }
      Run& run = runs[found->run];
      run.unknown = run.unknown || stretch.unknown;
    }
    replaced.push_back(piece);
    left = left.subspan(count);
  }
  const std::size_t end = stretch.first + stretch.count;
  Pose& next = end < way.pieces.size() ? way.pieces[end].to : way.last;
  next = before * next;
  replaced.insert(replaced.end(), way.pieces.begin() + static_cast<std::ptrdiff_t>(end), way.pieces.end());
  way.pieces = std::move(replaced);
  way.frames.resize(way.pieces.size());
}

}  // namespace

std::vector<Run> share_runs(std::span<const WayOfStep> ways) {
  Sharing sharing;
  for (const WayOfStep& way : ways) {
    for (const Stretch& stretch : stretches_of(way)) sharing.count(stretch);
  }
  sharing.choose();
  for (const WayOfStep& way : ways) {
    const std::vector<Stretch> stretches = stretches_of(way);
    // From the end, so that the numbers of what is left stay.
    std::for_each(stretches.rbegin(), stretches.rend(), [&](const Stretch& s) { sharing.replace(s); });
  }
  return std::move(sharing.runs);
}

}  // namespace koppel
