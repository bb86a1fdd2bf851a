// Saving a simulation and going on from what was saved.
#include <array>

#include "dynamics/simulation.hpp"

namespace koppel {
namespace {

constexpr std::array<char, 8> mark{'k', 'o', 'p', 'p', 'e', 'l', 's', 'm'};
constexpr std::uint32_t version = 2;  // of the order in which members are told

/// FNV-1a: tells a damaged file, not a forged one.
std::uint64_t sum_of(std::span<const unsigned char> bytes) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  for (const unsigned char byte : bytes) sum = (sum ^ byte) * 0x100000001b3u;
  return sum;
}

void exchange_mark(Archive& archive, std::array<char, 8>& text, std::uint32_t& number, std::uint64_t& hash) {
  for (char& letter : text) archive(letter);
  archive(number, hash);
}

tl::unexpected<Error> refused(std::string message, std::string advice) {
  return tl::make_unexpected(make_error(Code::invalid_argument, {}, std::move(message), std::move(advice)));
}

}  // namespace

bool Simulation::exchange(Archive& archive) {
  archive(shown_, balance_, lowest_, highest_, liveliest_, worn_);
  SimulationSummary& s = summary_;
  archive(s.steps, s.rejected, s.evaluations, s.events, s.switches, s.energy, s.energy_error, s.energy_size);
  archive(s.position_drift, s.velocity_drift, s.stiff, s.start_change);
  return archive.good() && equation_->exchange(archive) && method_->exchange(archive) && watch_.exchange(archive) &&
         crossings_.exchange(archive);
}

Result<std::vector<unsigned char>> Simulation::save() {
  if (failed_) return tl::make_unexpected(*failed_);
  const double end = method_->time();
  if (!method_->pause(shown_) || (method_->time() != end && !watch_.go_back(*method_)))
    return tl::make_unexpected(stuck(shown_).error());
  std::vector<unsigned char> bytes;
  Archive archive(bytes);
  auto text = mark;
  std::uint32_t number = version;
  std::uint64_t hash = mechanism_->hash;
  exchange_mark(archive, text, number, hash);
  archive(options_.formulation, options_.integrator, options_.tolerance, options_.step, options_.end);
  if (!exchange(archive)) return tl::make_unexpected(stuck(shown_).error());
  std::uint64_t sum = sum_of(bytes);
  archive(sum);
  return bytes;
}

Result<std::unique_ptr<Simulation>> Simulation::load(std::shared_ptr<const Mechanism> mechanism,
                                                     std::span<const unsigned char> bytes) {
  const char* const again = "simulate from the start, or give the file of another checkpoint";
  Archive archive(bytes);
  std::array<char, 8> text{};
  std::uint32_t number = 0;
  std::uint64_t hash = 0, sum = 0;
  exchange_mark(archive, text, number, hash);
  if (!archive.good() || text != mark) return refused("this is not a saved simulation", again);
  if (number != version) {
    return refused(
        "saved in format " + std::to_string(number) + ", and this library knows format " + std::to_string(version),
        "go on with the version that saved it, or simulate from the start");
  }
  if (hash != mechanism->hash) {
    return refused("it was saved with another scene, or with this one before a change",
                   "give the scene that it was saved with, or simulate from the start");
  }
  Archive end(bytes.size() < sizeof sum ? bytes : bytes.last(sizeof sum));
  end(sum);
  if (!end.good() || sum != sum_of(bytes.first(bytes.size() - sizeof sum))) return refused("it is damaged", again);
  SimulationOptions options;
  archive(options.formulation, options.integrator, options.tolerance, options.step, options.end);
  if (static_cast<std::size_t>(options.integrator) >= integrators().size() ||
      static_cast<std::size_t>(options.formulation) >= formulations().size()) {
    return refused("it is damaged", again);
  }
  KOPPEL_TRY(auto simulation, of(std::move(mechanism), options));
  simulation->method_ = make_integrator(options.integrator, *simulation->equation_, options.tolerance, options.step);
  if (!simulation->exchange(archive)) return refused("it is damaged, or was saved with other plugins", again);
  return simulation;
}

}  // namespace koppel
