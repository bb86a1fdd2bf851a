#include "dynamics/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace koppel {
namespace {

bool wanted(const Watch& watch, bool rising) {
  return watch.direction == Direction::either || (watch.direction == Direction::rising) == rising;
}

}  // namespace

Crossings::Crossings(EquationsOfMotion& motion, MotionEquation& equation)
    : motion_(motion), equation_(equation), sides_(Eigen::VectorXd::Zero(std::ssize(motion.mechanism().watches))) {}

/// How far a watched quantity is beyond its value where the motion stands.
double Crossings::value(std::size_t i) const {
  const Watch& watch = motion_.mechanism().watches[i];
  return (watch.rate ? motion_.v()[watch.at] : motion_.q()[watch.at]) - watch.value;
}

void Crossings::take_sides() {
  for (std::size_t i = 0; i < motion_.mechanism().watches.size(); ++i) take_side(i);
}

void Crossings::take_side(std::size_t i) {
  const double here = value(i);
  if (here != 0.0) sides_[static_cast<Eigen::Index>(i)] = here > 0.0 ? 1.0 : -1.0;
}

/// Whether it lies on the other side where the motion stands, and was looked for in that direction.
bool Crossings::is_crossed(std::size_t i) const {
  const double here = value(i);
  return here * sides_[static_cast<Eigen::Index>(i)] < 0.0 && wanted(motion_.mechanism().watches[i], here > 0.0);
}

bool Crossings::exchange(Archive& archive) {
  const Eigen::Index count = sides_.size();
  archive(sides_);
  return archive.good() && sides_.size() == count;
}

bool Crossings::stand(Integrator& method, double t) {
  method.interpolate(t, y_);
  return equation_.place(t, y_);
}

bool Crossings::find(Integrator& method, double from, double until, std::optional<Crossing>& found) {
  found.reset();
  const std::size_t count = motion_.mechanism().watches.size();
  if (count == 0) return true;
  if (!stand(method, until)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_crossed(i)) continue;
    Crossing crossing{static_cast<std::uint32_t>(i), until, value(i) > 0.0};
    if (!locate(method, i, from, crossing.time)) return false;
    if (!found || crossing.time < found->time) found = crossing;
    if (!stand(method, until)) return false;
  }
  if (found && !stand(method, found->time)) return false;
  // Others that are crossed at the same time are found from there on.
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_crossed(i) || (found && found->watch == i)) take_side(i);
  }
  return true;
}

/// By the secant's root, with the weight of an end that stays halved (Illinois), in turns with halving. Before, the
/// motion stands at `time`, where it is crossed.
bool Crossings::locate(Integrator& method, std::size_t watch, double from, double& time) {
  const double side = sides_[static_cast<Eigen::Index>(watch)];
  double low = from, high = time, at_high = value(watch);
  const double grain = 4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(from), std::abs(time));
  if (!stand(method, low)) return false;
  double at_low = value(watch);
  if (at_low * side < 0.0) high = low;  // it met another one's time
  for (int i = 0; high - low > grain; ++i) {
    const double part = at_low / (at_low - at_high);
    const double t = i % 3 == 2 || !(part > 0.0 && part < 1.0) ? 0.5 * (low + high) : low + part * (high - low);
    if (!(t > low) || !(t < high)) break;
    if (!stand(method, t)) return false;
    const double here = value(watch);
    if (here * side < 0.0) {
      high = t;
      at_high = here;
      at_low *= 0.5;
    } else {
      low = t;
      at_low = here;
      at_high *= 0.5;
    }
  }
  time = high;
  return true;
}

}  // namespace koppel
