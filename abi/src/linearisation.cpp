#include "dynamics/linearisation.hpp"

#include "boundary.hpp"
#include "closure/close.hpp"
#include "copy_matrix.hpp"

namespace {

const koppel::NamedNumber* number_of(const koppel_linearisation* linearisation, std::int32_t kind, std::size_t index) {
  if (linearisation == nullptr) return nullptr;
  const koppel::Linearisation& from = linearisation->linearisation;
  const std::vector<koppel::NamedNumber>* of = kind == KOPPEL_LINEAR_STATE    ? &from.states
                                               : kind == KOPPEL_LINEAR_INPUT  ? &from.inputs
                                               : kind == KOPPEL_LINEAR_OUTPUT ? &from.outputs
                                                                              : nullptr;
  return of == nullptr || index >= of->size() ? nullptr : &(*of)[index];
}

}  // namespace

koppel_status koppel_linearise(const koppel_state* state, const koppel_linearisation_options* options,
                               koppel_linearisation** linearisation, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (state == nullptr || linearisation == nullptr) {
      return koppel::invalid_argument("state or linearisation is NULL", error);
    }
    const koppel_linearisation_options given = koppel::read_struct(options);
    if (given.drives < KOPPEL_DRIVES_HELD || given.drives > KOPPEL_DRIVES_MOVING) {
      return koppel::invalid_argument("an option has no such value", error);
    }
    if (given.effort_count > 0 && given.efforts == nullptr) return koppel::invalid_argument("efforts is NULL", error);
    if (given.equilibrium != nullptr && given.equilibrium->mechanism != state->mechanism) {
      return koppel::invalid_argument("state and equilibrium belong to different mechanisms", error);
    }
    if (given.equilibrium == nullptr && !koppel::is_closed(*state->mechanism, state->state)) {
      return koppel::invalid_argument("the state is not closed: koppel_close comes first", error);
    }
    koppel::LinearisationOptions how;
    how.held = given.drives == KOPPEL_DRIVES_HELD;
    for (std::size_t i = 0; i < given.effort_count; ++i) {
      if (given.efforts[i] >= state->mechanism->nv) return koppel::invalid_argument("there is no such rate", error);
      how.efforts.push_back(given.efforts[i]);
    }
    koppel::State place = state->state;
    if (given.equilibrium != nullptr &&
        koppel::take_place(*state->mechanism, given.equilibrium->equilibrium, place) != nullptr) {
      return KOPPEL_PLUGIN;
    }
    auto made = koppel::linearise(state->mechanism, place, how);
    if (!made) return koppel::fail(made.error(), error);
    *linearisation = new koppel_linearisation{state->registry, state->mechanism, std::move(*made)};
    return KOPPEL_OK;
  });
}

void koppel_linearisation_destroy(koppel_linearisation* linearisation) { delete linearisation; }

koppel_status koppel_linearisation_summarise(const koppel_linearisation* linearisation,
                                             koppel_linearisation_summary* summary) {
  if (linearisation == nullptr || summary == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const koppel::Linearisation& from = linearisation->linearisation;
  koppel_linearisation_summary out{};
  out.course = from.course == koppel::Course::resting  ? KOPPEL_COURSE_RESTING
               : from.course == koppel::Course::steady ? KOPPEL_COURSE_STEADY
                                                       : KOPPEL_COURSE_UNSTEADY;
  out.freedoms = static_cast<std::uint32_t>(from.independent.size());
  out.states = static_cast<std::uint32_t>(from.states.size());
  out.inputs = static_cast<std::uint32_t>(from.inputs.size());
  out.outputs = static_cast<std::uint32_t>(from.outputs.size());
  out.drift = from.drift;
  koppel::write_struct(out, summary);
  return KOPPEL_OK;
}

koppel_status koppel_linearisation_name(const koppel_linearisation* linearisation, int32_t kind, size_t index,
                                        char* text, size_t size, size_t* needed) {
  const koppel::NamedNumber* number = number_of(linearisation, kind, index);
  return number == nullptr ? KOPPEL_INVALID_ARGUMENT : koppel::write_text(number->name, text, size, needed);
}

koppel_status koppel_linearisation_unit(const koppel_linearisation* linearisation, int32_t kind, size_t index,
                                        char* text, size_t size, size_t* needed) {
  const koppel::NamedNumber* number = number_of(linearisation, kind, index);
  return number == nullptr ? KOPPEL_INVALID_ARGUMENT : koppel::write_text(number->unit, text, size, needed);
}

koppel_status koppel_linearisation_matrix(const koppel_linearisation* linearisation, int32_t what, double* values,
                                          double* errors, size_t count) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (linearisation == nullptr) return KOPPEL_INVALID_ARGUMENT;
    const koppel::Linearisation& from = linearisation->linearisation;
    switch (what) {
      case KOPPEL_MATRIX_A: return koppel::copy_matrix(from.a, values, errors, count);
      case KOPPEL_MATRIX_B: return koppel::copy_matrix(from.b, values, errors, count);
      case KOPPEL_MATRIX_C: return koppel::copy_matrix(from.c, values, errors, count);
      case KOPPEL_MATRIX_D: return koppel::copy_matrix(from.d, values, errors, count);
      case KOPPEL_MATRIX_STIFFNESS: return koppel::copy_matrix(from.stiffness, values, errors, count);
      case KOPPEL_MATRIX_DAMPING: return koppel::copy_matrix(from.damping, values, errors, count);
      case KOPPEL_MATRIX_MASS:
        return koppel::copy_matrix({from.mass, Eigen::MatrixXd::Zero(from.mass.rows(), from.mass.cols())}, values,
                                   errors, count);
      default: return KOPPEL_INVALID_ARGUMENT;
    }
  });
}

koppel_status koppel_linearisation_mode(const koppel_linearisation* linearisation, size_t index, koppel_eigenmode* mode,
                                        double* shape_real, double* shape_imaginary, size_t count) {
  if (linearisation == nullptr || mode == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const koppel::Linearisation& from = linearisation->linearisation;
  if (index >= from.modes.size() || count != linearisation->mechanism->nv) return KOPPEL_INVALID_ARGUMENT;
  const koppel::NaturalMode& of = from.modes[index];
  koppel_eigenmode out{};
  out.real = of.eigenvalue.real();
  out.imaginary = of.eigenvalue.imag();
  out.error = of.error;
  koppel::write_struct(out, mode);
  for (std::size_t i = 0; i < count; ++i) {
    const std::complex<double> z = of.shape[static_cast<Eigen::Index>(i)];
    if (shape_real != nullptr) shape_real[i] = z.real();
    if (shape_imaginary != nullptr) shape_imaginary[i] = z.imag();
  }
  return KOPPEL_OK;
}
