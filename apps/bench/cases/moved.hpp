// A scene from text that is moved by its drives, and plane four-bars to be moved.
#pragma once

#include <string>

#include "common/model.hpp"

namespace koppel::app::bench {

class Moved {
 public:
  explicit Moved(const std::string& scene) : Moved(load_text(scene)) {}
  explicit Moved(Model model);

  /// Goes to a time; false: it does not, and report() tells why.
  bool to(double time, int branch = KOPPEL_BRANCH_STAY);
  /// Goes on along its curve, past limits of its drives.
  bool along(double duration);
  /// Closes for the inputs of the present time from where its coordinates are.
  bool close();

  const koppel_report& report() const { return report_; }
  /// NaN if there is none of that name.
  double q(const std::string& coordinate) const;
  /// The greatest residual and the number of change points of all steps so far.
  double residual() const { return residual_; }
  int change_points() const { return change_points_; }
  const Model& model() const { return model_; }
  const Motion& motion() const { return motion_; }
  std::string message() const { return error_.message; }

 private:
  bool took(koppel_status status);

  Model model_;
  Motion motion_;
  koppel_report report_ = sized<koppel_report>();
  koppel_error error_ = sized<koppel_error>();
  double residual_ = 0.0;
  int change_points_ = 0;
};

/// A plane four-bar: the crank turns about the origin, the rocker about (ground, 0) [m].
struct FourBar {
  double ground, crank, coupler, rocker;
  double scale = 1.0;       ///< of all lengths
  double x = 0.0, y = 0.0;  ///< of the crank's pivot [m], unscaled
  double height = 0.0;      ///< of the whole plane

  /// Angle of the rocker for one of the crank [rad]. side: 1 or -1, on which side of the line from the rocker's pivot
  /// to the crank's end the coupler's end lies. NaN out of reach.
  double rocker_angle(double crank_angle, int side) const;
  /// Its scene, with crank.angle driven from `start` at `slope` [rad/s], closed at the start on that side.
  std::string scene(double start, double slope, int side) const;
};

/// The difference of two angles but for full turns; NaN counts as far.
double apart(double angle, double other);

}  // namespace koppel::app::bench
