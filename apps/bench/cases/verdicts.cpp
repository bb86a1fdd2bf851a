// Starts from far away, inputs out of reach, and counts of closed positions: no verdict may be wrong.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <sstream>
#include <vector>

#include "bench/cases.hpp"
#include "bench/cases/moved.hpp"

namespace koppel::app::bench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double exact = 1e-12;

/// Sets all scalar coordinates anywhere within half a turn, or within the scene's length; inputs stay.
class Scatter {
 public:
  void operator()(Moved& moved) {
    const koppel_sizes sizes = moved.model().sizes();
    const double length = moved.model().settings().length;
    std::vector<double> q(sizes.coordinates);
    koppel_state_get(moved.motion().state.get(), KOPPEL_Q, q.data(), q.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      const std::string unit = moved.model().unit(KOPPEL_KIND_COORDINATE, i);
      q[i] = unit == "m"     ? q[i] + 0.5 * length * part_(engine_)
             : unit == "rad" ? std::numbers::pi * part_(engine_)
                             : part_(engine_);
    }
    koppel_state_set(moved.motion().state.get(), KOPPEL_Q, q.data(), q.size());
  }

 private:
  std::mt19937 engine_{4};
  std::uniform_real_distribution<double> part_{-1.0, 1.0};
};

int starts(const Plan& plan) { return plan.quick ? 50 : 10000; }

std::string count(int closed, int all) { return std::to_string(closed) + " of " + std::to_string(all) + " closed"; }

/// Closes from anywhere, each time; error(moved): of a start that closed.
template <typename Make, typename Error>
Outcome all_close(int all, const Make& make, const Error& error) {
  Scatter scatter;
  double worst = 0.0;
  int closed = 0;
  for (int i = 0; i < all; ++i) {
    Moved moved(make());
    scatter(moved);
    if (!moved.close()) continue;
    ++closed;
    worst = std::max(worst, error(moved));
  }
  if (closed < all) worst = infinity;
  return {count(closed, all), worst, exact};
}

Outcome far_starts(const Plan& plan) {
  constexpr FourBar bar{0.35, 0.1, 0.335, 0.255};
  constexpr double crank = 0.9;
  return all_close(
      starts(plan), [&] { return bar.scene(crank, 0.0, 1); },
      [&](const Moved& moved) {
        return std::min(apart(moved.q("rocker.angle"), bar.rocker_angle(crank, 1)),
                        apart(moved.q("rocker.angle"), bar.rocker_angle(crank, -1)));
      });
}

/// Of a shipped scene; by its residuals.
Outcome far_starts_of(const Plan& plan, const char* scene) {
  return all_close(
      starts(plan), [&] { return load(plan.scenes + '/' + scene + ".toml", false); },
      [](const Moved& moved) { return moved.report().residual; });
}

Outcome far_starts_in_space(const Plan& plan) { return far_starts_of(plan, "rstr"); }
Outcome far_starts_of_a_suspension(const Plan& plan) { return far_starts_of(plan, "5link"); }

Outcome far_starts_of_a_platform(const Plan& plan) {
  Scatter scatter;
  double worst = 0.0;
  int closed = 0;
  const int all = plan.quick ? 2 : 10;
  for (int i = 0; i < all; ++i) {
    Moved moved(load(plan.scenes + "/stewart.toml", false));
    scatter(moved);
    if (!moved.close()) {
      if (moved.report().verdict != KOPPEL_VERDICT_NOT_FOUND)
        return {std::string("a wrong verdict: ") + moved.message(), infinity, exact};
      continue;
    }
    ++closed;
    worst = std::max(worst, moved.report().residual);
  }
  return {count(closed, all), worst, exact};
}

Outcome out_of_reach(const Plan&) {
  // The ground is longer than all other links together, by one part in 10, 10^3 and 10^6.
  Scatter scatter;
  int certain = 0, all = 0;
  for (const double part : {1e-1, 1e-3, 1e-6}) {
    constexpr FourBar bar{0.69, 0.1, 0.335, 0.255};
    std::string scene = bar.scene(0.0, 0.0, 1);
    // Closed with the crank along the ground: its links are stretched to 0.69. Then the ground is moved away.
    const std::string pivot = "[0.68999999999999995";
    std::ostringstream moved_pivot;
    moved_pivot << std::setprecision(17) << '[' << 0.69 * (1.0 + part);
    scene.replace(scene.find(pivot), pivot.size(), moved_pivot.str());
    for (int i = 0; i < 10; ++i) {
      Moved moved(scene);
      if (i > 0) scatter(moved);
      ++all;
      if (moved.close()) return {"closed what cannot close", infinity, 0.0};
      if (moved.report().verdict == KOPPEL_VERDICT_UNREACHABLE) ++certain;
    }
  }
  const std::string found = std::to_string(certain) + " of " + std::to_string(all) + " known to be out of reach";
  return {found, static_cast<double>(all - certain), 0.0};
}

struct ModesDelete {
  void operator()(koppel_modes* modes) const { koppel_modes_destroy(modes); }
};

/// All closed positions of a scene that has a known number of them; their residuals.
Outcome all_positions(const Plan& plan, const char* scene, std::uint64_t expected) {
  Moved moved(load(plan.scenes + '/' + scene + ".toml", false));
  koppel_modes* found = nullptr;
  auto error = sized<koppel_error>();
  if (koppel_modes_find(moved.motion().state.get(), moved.motion().work.get(), nullptr, &found, &error) < 0) {
    return {error.message, infinity, exact};
  }
  const std::unique_ptr<koppel_modes, ModesDelete> modes(found);
  auto summary = sized<koppel_modes_summary>();
  koppel_modes_summarise(found, &summary);
  double worst = 0.0;
  for (std::size_t i = 0; i < summary.count; ++i) {
    auto mode = sized<koppel_mode>();
    koppel_modes_get(found, i, &mode);
    worst = std::max(worst, mode.residual);
  }
  const std::string text = std::to_string(summary.count) + " positions" + (summary.complete != 0 ? ", complete" : "");
  if (summary.count != expected || summary.complete == 0) worst = infinity;
  return {text, worst, exact};
}

Outcome sixteen(const Plan& plan) { return all_positions(plan, "7r", 16); }

}  // namespace

std::vector<Case> verdicts() {
  return {
      {"far_starts", "a four-bar closed from anywhere",
       "each of 10^4 starts (50 with --quick) closes to one of its two positions, to 1e-12", far_starts},
      {"far_starts_in_space", "a spatial four-bar closed from anywhere",
       "each of 10^4 starts (50 with --quick) closes to 1e-12", far_starts_in_space},
      {"far_starts_of_a_suspension", "a five-link suspension closed from anywhere",
       "each of 10^4 starts (50 with --quick) closes to 1e-12", far_starts_of_a_suspension},
      {"far_starts_of_a_platform", "a platform on six legs closed from anywhere",
       "what is called closed is closed to 1e-12; what is not says that nothing was found", far_starts_of_a_platform},
      {"out_of_reach", "a four-bar whose ground is too long, by 1 in 10 to 1 in a million",
       "known to be out of reach, from whatever start", out_of_reach},
      {"sixteen_positions", "a loop of seven turns, nearly singular, that has sixteen positions (Manseur and Doty)",
       "all sixteen, each to 1e-12, and no others", sixteen},
  };
}

}  // namespace koppel::app::bench
