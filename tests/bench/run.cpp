#include "run.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "folders.hpp"
#include "scene/scene.hpp"
#include "standard_types.hpp"

namespace koppel::bench {
namespace {

/// Compiles a scene and moves it through its run.
Result<Run> moved(Run run, const Scene& scene, const std::string& name, Diagnostics& findings) {
  KOPPEL_TRY(run.mechanism, compile(scene, findings));
  const Mechanism& mechanism = *run.mechanism;
  Work work(run.mechanism);
  State state(mechanism);
  for (std::uint32_t step = 0; step <= mechanism.run_steps; ++step) {
    run.times.push_back(mechanism.duration * step / mechanism.run_steps);
    Report report;
    if (move(work, state, run.times.back(), report) < 0) {
      return tl::make_unexpected(make_error(Code::not_closed, "scene " + name, "the run of the scene does not close"));
    }
    run.states.push_back(state);
  }
  return run;
}

/// Bell cranks 0.35 m apart with arms of 0.15 m, upright, and couplers as long from each to the next: parallelograms.
std::string chain_text(int count) {
  std::ostringstream bodies, joints;
  bodies << "schema = 1\n[scene]\nname = 'row'\nduration = 1\nsteps = 90\n[[body]]\nname = 'bell0'\n";
  joints << "[[joint]]\nname = 'bell0'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'bell0'\n"
            "[[drive]]\nof = 'bell0.angle'\ntype = 'sine'\noffset = '90 deg'\namplitude = '20 deg'\nfrequency = 1\n";
  for (int i = 1; i <= count; ++i) {
    bodies << "[[body]]\nname = 'coupler" << i << "'\n[[body]]\nname = 'bell" << i << "'\n";
    joints << "[[joint]]\nname = 'pin" << i << "'\ntype = 'revolute'\ninlet = { on = 'bell" << i - 1
           << "', at = [0.15, 0, 0] }\noutlet = 'coupler" << i << "'\nstart = { angle = '-90 deg' }\n"
           << "[[joint]]\nname = 'bell" << i << "'\ntype = 'revolute'\ninlet = { on = 'ground', at = [" << 0.35 * i
           << ", 0, 0] }\noutlet = 'bell" << i << "'\nstart = { angle = '90 deg' }\n"
           << "[[joint]]\nname = 'tip" << i << "'\ntype = 'revolute'\ninlet = { on = 'bell" << i
           << "', at = [0.15, 0, 0] }\noutlet = { on = 'coupler" << i << "', at = [0.35, 0, 0] }\n";
  }
  return bodies.str() + joints.str();
}

}  // namespace

Result<Run> load(const std::string& name) {
  Run run;
  run.registry = standard_types();
  Diagnostics findings;
  KOPPEL_TRY(const Scene scene, read_scene_file(*run.registry, test::scenes_folder() + "/" + name + ".toml", findings));
  return moved(std::move(run), scene, name, findings);
}

Result<Run> load_chain(int count) {
  Run run;
  run.registry = standard_types();
  Diagnostics findings;
  KOPPEL_TRY(const Scene scene, read_scene_text(*run.registry, chain_text(count), {}, findings));
  return moved(std::move(run), scene, "row", findings);
}

void Figures::take(const Report& report) {
  residual_ = std::max(residual_, report.residual);
  coordinate_error_ = std::max(coordinate_error_, report.coordinate_error);
  iterations_ += report.iterations;
  ++closures_;
}

void Figures::show(benchmark::State& state) const {
  state.counters["residual"] = residual_;
  state.counters["coordinate_error"] = coordinate_error_;
  state.counters["iterations"] =
      closures_ == 0 ? 0.0 : static_cast<double>(iterations_) / static_cast<double>(closures_);
  state.counters["equations"] = mechanism_.rows;
  state.counters["unknowns"] = mechanism_.unknowns;
}

}  // namespace koppel::bench
