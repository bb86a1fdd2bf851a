// Owners of the handles that koppel.h hands out, and helpers for its sized structs and its texts.
#pragma once

#include <memory>
#include <string>

#include "koppel/koppel.h"

namespace koppel::app {

template <auto destroy>
struct Destroy {
  template <typename Handle>
  void operator()(Handle* handle) const {
    destroy(handle);
  }
};

using Engine = std::unique_ptr<koppel_engine, Destroy<koppel_engine_destroy>>;
using Diagnostics = std::unique_ptr<koppel_diagnostics, Destroy<koppel_diagnostics_destroy>>;
using Scene = std::unique_ptr<koppel_scene, Destroy<koppel_scene_destroy>>;
using Mechanism = std::unique_ptr<koppel_mechanism, Destroy<koppel_mechanism_destroy>>;
using State = std::unique_ptr<koppel_state, Destroy<koppel_state_destroy>>;
using Work = std::unique_ptr<koppel_work, Destroy<koppel_work_destroy>>;
using Simulation = std::unique_ptr<koppel_simulation, Destroy<koppel_simulation_destroy>>;
using Equilibrium = std::unique_ptr<koppel_equilibrium, Destroy<koppel_equilibrium_destroy>>;
using Linearisation = std::unique_ptr<koppel_linearisation, Destroy<koppel_linearisation_destroy>>;
using Tree = std::unique_ptr<koppel_tree, Destroy<koppel_tree_destroy>>;
using Modes = std::unique_ptr<koppel_modes, Destroy<koppel_modes_destroy>>;

struct CloseStream {
  void operator()(koppel_stream* stream) const { koppel_stream_close(stream, nullptr); }
};
using Stream = std::unique_ptr<koppel_stream, CloseStream>;

/// A zeroed struct of the ABI with its size set.
template <typename Struct>
Struct sized() {
  Struct value{};
  value.struct_size = sizeof(Struct);
  return value;
}

/// The text that an ABI function writes; write(buffer, size, needed) calls it. Empty if it fails.
template <typename Write>
std::string text_of(Write&& write) {
  size_t needed = 0;
  if (write(nullptr, size_t{0}, &needed) < 0 || needed == 0) return {};
  std::string text(needed, '\0');
  if (write(text.data(), text.size(), &needed) < 0) return {};
  text.pop_back();  // the final zero
  return text;
}

}  // namespace koppel::app
