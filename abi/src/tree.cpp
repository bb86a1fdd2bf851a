#include <cmath>
#include <initializer_list>

#include "boundary.hpp"

namespace {

using koppel::TreeDynamics;
using Obstacle = TreeDynamics::Obstacle;

enum class Kind { coordinates, rates };

/// What a batch is given for each state. Rates that are null stand for zero.
struct Input {
  Kind kind;
  const char* name;
  const double* numbers;
};

/// What a batch writes.
struct Output {
  const char* name;
  double* numbers;
};

/// Where a state stands in the arrays of a batch. Null arrays stay null.
struct Place {
  std::size_t index, nq, nv;

  const double* coordinates(const double* q) const { return at(q, nq); }
  const double* rates(const double* numbers) const { return at(numbers, nv); }

  template <typename Numbers>
  void write(const Numbers& from, double* to) const {
    if (to != nullptr) std::copy(from.data(), from.data() + from.size(), at(to, static_cast<std::size_t>(from.size())));
  }
  void write(double from, double* to) const {
    if (to != nullptr) to[index] = from;
  }

 private:
  template <typename Number>
  Number* at(Number* numbers, std::size_t width) const {
    return numbers == nullptr ? nullptr : numbers + index * width;
  }
};

std::string numbered_state(std::size_t i) { return "state " + std::to_string(i) + " of the batch"; }

koppel_status check(const koppel::Mechanism& mechanism, const Input& input, std::size_t count, koppel_error* error) {
  const bool is_q = input.kind == Kind::coordinates;
  const std::vector<koppel::NamedNumber>& names = is_q ? mechanism.coordinate_names : mechanism.rate_names;
  if (input.numbers == nullptr) {
    if (!is_q || names.empty() || count == 0) return KOPPEL_OK;
    return koppel::invalid_argument(std::string(input.name) + " is NULL", error);
  }
  for (std::size_t k = 0; k < count * names.size(); ++k) {
    if (std::isfinite(input.numbers[k])) continue;
    return koppel::invalid_argument("in " + std::string(input.name) + " of " + numbered_state(k / names.size()) +
                                        ", `" + names[k % names.size()].name + "` is not finite",
                                    error);
  }
  return KOPPEL_OK;
}

/// Checks all that is given, then calls evaluate(dynamics, place) for each state. `needed`: outputs that may not be
/// null.
template <typename Evaluate>
koppel_status each(koppel_tree* tree, std::size_t count, std::initializer_list<Input> inputs,
                   std::initializer_list<Output> needed, koppel_error* error, const Evaluate& evaluate) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (tree == nullptr) return koppel::invalid_argument("tree is NULL", error);
    const koppel::Mechanism& mechanism = tree->dynamics->mechanism();
    for (const Input& input : inputs) {
      if (const koppel_status status = check(mechanism, input, count, error); status < 0) return status;
    }
    for (const Output& output : needed) {
      if (output.numbers != nullptr || count == 0 || mechanism.nv == 0) continue;
      return koppel::invalid_argument(std::string(output.name) + " is NULL", error);
    }
    for (std::size_t i = 0; i < count; ++i) {
      Obstacle obstacle = evaluate(*tree->dynamics, Place{i, mechanism.nq, mechanism.nv});
      if (!obstacle) continue;
      obstacle->message += ", in " + numbered_state(i);
      return koppel::fail(*obstacle, error);
    }
    return KOPPEL_OK;
  });
}

Input coordinates(const double* q) { return {Kind::coordinates, "q", q}; }
Input rates(const char* name, const double* numbers) { return {Kind::rates, name, numbers}; }

}  // namespace

koppel_status koppel_tree_create(const koppel_mechanism* mechanism, koppel_tree** tree, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (mechanism == nullptr || tree == nullptr) return koppel::invalid_argument("mechanism or tree is NULL", error);
    auto inertias = koppel::inertias(*mechanism->mechanism);
    if (!inertias) return koppel::fail(inertias.error(), error);
    auto dynamics = std::make_unique<TreeDynamics>(mechanism->mechanism, std::move(*inertias));
    *tree = new koppel_tree{mechanism->registry, std::move(dynamics)};
    return KOPPEL_OK;
  });
}

void koppel_tree_destroy(koppel_tree* tree) { delete tree; }

koppel_status koppel_tree_inverse_dynamics(koppel_tree* tree, size_t count, const double* q, const double* v,
                                           const double* a, double* efforts, koppel_error* error) {
  return each(tree, count, {coordinates(q), rates("v", v), rates("a", a)}, {{"efforts", efforts}}, error,
              [&](TreeDynamics& dynamics, const Place& at) {
                Obstacle obstacle = dynamics.inverse(at.coordinates(q), at.rates(v), at.rates(a));
                if (!obstacle) at.write(dynamics.efforts(), efforts);
                return obstacle;
              });
}

koppel_status koppel_tree_forward_dynamics(koppel_tree* tree, size_t count, const double* q, const double* v,
                                           const double* efforts, double* a, koppel_error* error) {
  return each(tree, count, {coordinates(q), rates("v", v), rates("efforts", efforts)}, {{"a", a}}, error,
              [&](TreeDynamics& dynamics, const Place& at) {
                Obstacle obstacle = dynamics.forward(at.coordinates(q), at.rates(v), at.rates(efforts));
                if (!obstacle) at.write(dynamics.accelerations(), a);
                return obstacle;
              });
}

koppel_status koppel_tree_mass_matrix(koppel_tree* tree, size_t count, const double* q, double* mass,
                                      koppel_error* error) {
  return each(tree, count, {coordinates(q)}, {{"mass", mass}}, error, [&](TreeDynamics& dynamics, const Place& at) {
    Obstacle obstacle = dynamics.mass(at.coordinates(q));
    if (!obstacle) at.write(dynamics.mass_matrix(), mass);
    return obstacle;
  });
}

koppel_status koppel_tree_energy(koppel_tree* tree, size_t count, const double* q, const double* v, double* kinetic,
                                 double* potential, koppel_error* error) {
  return each(tree, count, {coordinates(q), rates("v", v)}, {}, error, [&](TreeDynamics& dynamics, const Place& at) {
    Obstacle obstacle = dynamics.energy(at.coordinates(q), at.rates(v));
    if (!obstacle) {
      at.write(dynamics.mechanical().kinetic, kinetic);
      at.write(dynamics.mechanical().potential, potential);
    }
    return obstacle;
  });
}

koppel_status koppel_tree_momentum(koppel_tree* tree, size_t count, const double* q, const double* v, double* mass,
                                   double* centre, double* momentum, double* angular_momentum, koppel_error* error) {
  return each(tree, count, {coordinates(q), rates("v", v)}, {}, error, [&](TreeDynamics& dynamics, const Place& at) {
    Obstacle obstacle = dynamics.energy(at.coordinates(q), at.rates(v));
    if (!obstacle) {
      at.write(dynamics.mechanical().mass, mass);
      at.write(dynamics.mechanical().centre, centre);
      at.write(dynamics.mechanical().momentum, momentum);
      at.write(dynamics.mechanical().angular_momentum, angular_momentum);
    }
    return obstacle;
  });
}

koppel_status koppel_tree_inverse_dynamics_derivatives(koppel_tree* tree, size_t count, const double* q,
                                                       const double* v, const double* a, double* by_q, double* by_v,
                                                       koppel_error* error) {
  return each(tree, count, {coordinates(q), rates("v", v), rates("a", a)}, {}, error,
              [&](TreeDynamics& dynamics, const Place& at) {
                Obstacle obstacle = dynamics.inverse_derivatives(at.coordinates(q), at.rates(v), at.rates(a));
                if (!obstacle) {
                  at.write(dynamics.by_q(), by_q);
                  at.write(dynamics.by_v(), by_v);
                }
                return obstacle;
              });
}

koppel_status koppel_tree_forward_dynamics_derivatives(koppel_tree* tree, size_t count, const double* q,
                                                       const double* v, const double* efforts, double* by_q,
                                                       double* by_v, double* by_effort, koppel_error* error) {
  return each(tree, count, {coordinates(q), rates("v", v), rates("efforts", efforts)}, {}, error,
              [&](TreeDynamics& dynamics, const Place& at) {
                Obstacle obstacle = dynamics.forward_derivatives(at.coordinates(q), at.rates(v), at.rates(efforts));
                if (!obstacle) {
                  at.write(dynamics.by_q(), by_q);
                  at.write(dynamics.by_v(), by_v);
                  at.write(dynamics.by_effort(), by_effort);
                }
                return obstacle;
              });
}
