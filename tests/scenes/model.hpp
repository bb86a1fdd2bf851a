// Scenes as these tests drive them: through the C ABI alone. What must not fail throws std::runtime_error, which ends
// the test with the engine's own words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/handles.hpp"

namespace koppel::test {

/// Where an engine finds its plugins; empty: as koppel_engine_options has it.
struct Plugins {
  std::string path;
  std::string standard;
};

/// A compiled scene.
class Model {
 public:
  /// Reads a scene that names no other files.
  explicit Model(std::string_view text, const Plugins& plugins = {});

  const koppel_mechanism* get() const { return mechanism_.get(); }
  const koppel_sizes& sizes() const { return sizes_; }
  const koppel_settings& settings() const { return settings_; }
  /// kind: KOPPEL_KIND_BODY and so on.
  std::string name(std::int32_t kind, std::size_t index) const;
  std::string unit(std::int32_t kind, std::size_t index) const;
  std::size_t find(std::int32_t kind, const std::string& name) const;
  /// How many bodies or named frames there are.
  std::size_t count(std::int32_t kind) const;
  /// The time of a step of the scene's own run.
  double time(std::size_t step) const { return settings_.duration * static_cast<double>(step) / settings_.steps; }

 private:
  app::Mechanism mechanism_;
  koppel_sizes sizes_ = app::sized<koppel_sizes>();
  koppel_settings settings_ = app::sized<koppel_settings>();
};

/// How a call went.
struct Outcome {
  koppel_status status = KOPPEL_OK;
  koppel_report report = app::sized<koppel_report>();
  std::string message;
  explicit operator bool() const { return status >= 0; }
};

/// A state of a model, with scratch memory of its own. The model must outlive it.
class Motion {
 public:
  explicit Motion(const Model& model);
  /// A copy stands where the original stands and moves on its own.
  Motion(const Motion& other);
  Motion& operator=(const Motion&) = delete;

  const Model& model() const { return *model_; }
  koppel_state* state() { return state_.get(); }
  koppel_work* work() { return work_.get(); }

  /// koppel_move to a time, koppel_close, and koppel_velocities with koppel_accelerations.
  Outcome move(double time);
  Outcome close();
  Outcome rates();
  /// Moves to the last of the scene's own steps up to `step`; throws if one of them fails.
  Motion& run_to(std::size_t step);

  void set_positions(const Eigen::VectorXd& q);
  void set_input(std::size_t input, double value, double rate = 0.0);

  Eigen::VectorXd positions() const { return get(KOPPEL_Q, model_->sizes().coordinates); }
  Eigen::VectorXd velocities() const { return get(KOPPEL_V, model_->sizes().rates); }
  Eigen::VectorXd accelerations() const { return get(KOPPEL_A, model_->sizes().rates); }
  Eigen::VectorXd records();
  koppel_analysis analysis();

  /// Of all bodies or frames, one column for each: poses as 12 numbers, twists and accelerations as 6.
  Eigen::MatrixXd poses(std::int32_t kind);
  Eigen::MatrixXd twists(std::int32_t kind);
  Eigen::MatrixXd frame_accelerations(std::int32_t kind);
  struct Jacobian {
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> value, rate;
  };
  Jacobian jacobian(std::int32_t kind, std::size_t index);

 private:
  Eigen::VectorXd get(std::int32_t what, std::size_t count) const;
  template <typename Call>
  Eigen::MatrixXd each(Call call, std::int32_t kind, Eigen::Index rows);

  const Model* model_;
  app::State state_;
  app::Work work_;
};

/// Parts of one column of Motion::poses().
Eigen::Matrix3d rotation_of(const Eigen::Ref<const Eigen::VectorXd>& pose);
Eigen::Vector3d position_of(const Eigen::Ref<const Eigen::VectorXd>& pose);

/// Whether two vectors hold the same bits.
bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Names of all scenes in apps/scenes, without their ending, in alphabetical order.
std::vector<std::string> shipped_scenes();
std::string read_text(const std::string& file);
/// The text of a shipped scene.
std::string shipped_scene(const std::string& name);
/// A name for a test parameter: letters, digits and underscores of a text.
std::string test_name(std::string_view text);

}  // namespace koppel::test
