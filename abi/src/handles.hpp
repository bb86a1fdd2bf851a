// What the opaque handles hold. Each keeps alive what it was made from.
#pragma once

#include <memory>

#include "base/error.hpp"
#include "base/log.hpp"
#include "closure/modes.hpp"
#include "closure/work.hpp"
#include "dynamics/equilibrium.hpp"
#include "dynamics/linearisation.hpp"
#include "dynamics/reactions.hpp"
#include "dynamics/simulation.hpp"
#include "dynamics/tree_dynamics.hpp"
#include "koppel/koppel.h"
#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"
#include "plugin/registry.hpp"
#include "scene/scene.hpp"
#include "stream/publisher.hpp"

struct koppel_engine {
  koppel::Logger log;
  std::shared_ptr<koppel::Registry> registry;
};

struct koppel_diagnostics {
  koppel::Diagnostics list;
};

struct koppel_scene {
  std::shared_ptr<koppel::Registry> registry;
  koppel::Logger log;
  std::shared_ptr<const koppel::Scene> scene;
};

struct koppel_mechanism {
  std::shared_ptr<koppel::Registry> registry;
  koppel::Logger log;
  std::shared_ptr<const koppel::Mechanism> mechanism;
};

struct koppel_state {
  std::shared_ptr<koppel::Registry> registry;
  std::shared_ptr<const koppel::Mechanism> mechanism;
  koppel::State state;
};

struct koppel_work {
  std::shared_ptr<koppel::Registry> registry;
  koppel::Work work;
  std::unique_ptr<koppel::Reactions> reactions;  ///< built on first need
};

struct koppel_modes {
  std::shared_ptr<koppel::Registry> registry;
  std::shared_ptr<const koppel::Mechanism> mechanism;
  koppel::Modes modes;
};

struct koppel_simulation {
  std::shared_ptr<koppel::Registry> registry;
  std::shared_ptr<const koppel::Mechanism> mechanism;
  std::unique_ptr<koppel::Simulation> simulation;
};

struct koppel_equilibrium {
  std::shared_ptr<koppel::Registry> registry;
  std::shared_ptr<const koppel::Mechanism> mechanism;
  koppel::Equilibrium equilibrium;
};

struct koppel_linearisation {
  std::shared_ptr<koppel::Registry> registry;
  std::shared_ptr<const koppel::Mechanism> mechanism;
  koppel::Linearisation linearisation;
};

struct koppel_tree {
  std::shared_ptr<koppel::Registry> registry;
  std::unique_ptr<koppel::TreeDynamics> dynamics;
};

struct koppel_stream {
  std::shared_ptr<const koppel::Mechanism> mechanism;
  std::unique_ptr<koppel::Publisher> publisher;
  std::vector<double> poses;
};
