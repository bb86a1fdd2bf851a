#include "model.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "folders.hpp"

namespace koppel::test {
namespace {

/// Calls an ABI function that takes an error last; throws what it says.
template <typename Call>
void demand(const char* what, Call&& call) {
  auto error = app::sized<koppel_error>();
  if (call(&error) >= 0) return;
  throw std::runtime_error(std::string(what) + ": " + error.code + ' ' + error.element + ": " + error.message + " (" +
                           error.source_line + ')');
}

void demand(const char* what, koppel_status status) {
  if (status < 0) throw std::runtime_error(std::string(what) + " failed with status " + std::to_string(status));
}

app::Engine make_engine(const Plugins& plugins) {
  auto options = app::sized<koppel_engine_options>();
  if (!plugins.path.empty()) options.plugin_path = plugins.path.c_str();
  if (!plugins.standard.empty()) options.standard_plugins = plugins.standard.c_str();
  koppel_engine* engine = nullptr;
  demand("engine", [&](koppel_error* error) {
    return koppel_engine_create(KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, &options, &engine, error);
  });
  return app::Engine(engine);
}

}  // namespace

Model::Model(std::string_view text, const Plugins& plugins) {
  const app::Engine engine = make_engine(plugins);
  koppel_scene* scene = nullptr;
  demand("scene", [&](koppel_error* error) {
    return koppel_scene_from_text(engine.get(), text.data(), text.size(), nullptr, nullptr, &scene, error);
  });
  const app::Scene scene_owner(scene);
  koppel_mechanism* mechanism = nullptr;
  demand("compile", [&](koppel_error* error) { return koppel_mechanism_compile(scene, nullptr, &mechanism, error); });
  mechanism_.reset(mechanism);
  demand("sizes", koppel_mechanism_sizes(mechanism, &sizes_));
  demand("settings", koppel_mechanism_settings(mechanism, &settings_));
}

std::string Model::name(std::int32_t kind, std::size_t index) const {
  return app::text_of([&](char* text, std::size_t size, std::size_t* needed) {
    return koppel_mechanism_name(get(), kind, index, text, size, needed);
  });
}

std::string Model::unit(std::int32_t kind, std::size_t index) const {
  return app::text_of([&](char* text, std::size_t size, std::size_t* needed) {
    return koppel_mechanism_unit(get(), kind, index, text, size, needed);
  });
}

std::size_t Model::find(std::int32_t kind, const std::string& name) const {
  std::size_t index = 0;
  demand("find", [&](koppel_error* error) { return koppel_mechanism_find(get(), kind, name.c_str(), &index, error); });
  return index;
}

std::size_t Model::count(std::int32_t kind) const { return kind == KOPPEL_KIND_BODY ? sizes_.bodies : sizes_.frames; }

Motion::Motion(const Model& model) : model_(&model) {
  koppel_state* state = nullptr;
  demand("state", koppel_state_create(model.get(), &state));
  state_.reset(state);
  koppel_work* work = nullptr;
  demand("work", koppel_work_create(model.get(), &work));
  work_.reset(work);
}

Motion::Motion(const Motion& other) : Motion(other.model()) {
  demand("copy", koppel_state_copy(other.state_.get(), state_.get()));
}

Outcome Motion::move(double time) {
  Outcome outcome;
  auto error = app::sized<koppel_error>();
  outcome.status = koppel_move(state(), work(), time, &outcome.report, &error);
  outcome.message = error.message;
  return outcome;
}

Outcome Motion::close() {
  Outcome outcome;
  auto error = app::sized<koppel_error>();
  outcome.status = koppel_close(state(), work(), nullptr, &outcome.report, &error);
  outcome.message = error.message;
  return outcome;
}

Outcome Motion::rates() {
  Outcome outcome;
  auto error = app::sized<koppel_error>();
  outcome.status = koppel_velocities(state(), work(), &error);
  if (outcome) outcome.status = koppel_accelerations(state(), work(), &error);
  outcome.message = error.message;
  return outcome;
}

Motion& Motion::run_to(std::size_t step) {
  for (std::size_t i = 0; i <= step; ++i) {
    const Outcome outcome = move(model_->time(i));
    if (!outcome) throw std::runtime_error("step " + std::to_string(i) + ": " + outcome.message);
  }
  return *this;
}

void Motion::set_positions(const Eigen::VectorXd& q) {
  demand("state_set", koppel_state_set(state(), KOPPEL_Q, q.data(), static_cast<std::size_t>(q.size())));
}

void Motion::set_input(std::size_t input, double value, double rate) {
  demand("set_input", koppel_state_set_input(state(), input, value, rate, 0.0));
}

Eigen::VectorXd Motion::get(std::int32_t what, std::size_t count) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(count));
  demand("state_get", koppel_state_get(state_.get(), what, values.data(), count));
  return values;
}

Eigen::VectorXd Motion::records() {
  Eigen::VectorXd values(static_cast<Eigen::Index>(model_->sizes().records));
  demand("records", koppel_records(state(), work(), values.data(), model_->sizes().records));
  return values;
}

koppel_analysis Motion::analysis() {
  auto analysis = app::sized<koppel_analysis>();
  demand("analyse", [&](koppel_error* error) { return koppel_analyse(state(), work(), &analysis, error); });
  return analysis;
}

template <typename Call>
Eigen::MatrixXd Motion::each(Call call, std::int32_t kind, Eigen::Index rows) {
  Eigen::MatrixXd values(rows, static_cast<Eigen::Index>(model_->count(kind)));
  const auto numbers = static_cast<std::size_t>(values.size());
  if (numbers > 0) demand("results", call(state(), work(), kind, values.data(), numbers));
  return values;
}

Eigen::MatrixXd Motion::poses(std::int32_t kind) { return each(koppel_poses, kind, 12); }

Eigen::MatrixXd Motion::twists(std::int32_t kind) { return each(koppel_twists, kind, 6); }

Eigen::MatrixXd Motion::frame_accelerations(std::int32_t kind) { return each(koppel_frame_accelerations, kind, 6); }

Motion::Jacobian Motion::jacobian(std::int32_t kind, std::size_t index) {
  const std::size_t rates = model_->sizes().rates;
  Jacobian jacobian;
  jacobian.value.resize(6, static_cast<Eigen::Index>(rates));
  jacobian.rate.resize(6, static_cast<Eigen::Index>(rates));
  demand("jacobian",
         koppel_jacobian(state(), work(), kind, index, jacobian.value.data(), jacobian.rate.data(), 6 * rates));
  return jacobian;
}

Eigen::Matrix3d rotation_of(const Eigen::Ref<const Eigen::VectorXd>& pose) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.data());
}

Eigen::Vector3d position_of(const Eigen::Ref<const Eigen::VectorXd>& pose) { return pose.segment<3>(9); }

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0);
}

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(scenes_folder())) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string shipped_scene(const std::string& name) { return read_text(scenes_folder() + "/" + name + ".toml"); }

std::string test_name(std::string_view text) {
  std::string name;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  return name;
}

}  // namespace koppel::test
