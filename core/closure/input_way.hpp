// The way of the inputs: where all driven coordinates are, as functions of one parameter.
#pragma once

#include <Eigen/Core>

#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// Either what the drives say, with the time as the parameter, or a straight line in the space of the inputs.
class InputWay {
 public:
  /// As the drives go, from one time to another; the two only say how fast, for the scale.
  static InputWay of_drives(const Mechanism& mechanism, double from, double to);
  /// From the inputs' places in one state, at its last closed position, to what they should be; the parameter goes from
  /// 0 to 1, the time with it.
  static InputWay straight(const Mechanism& mechanism, const State& state);

  /// Where the inputs are. False: a drive failed; culprit() is it.
  bool evaluate(double parameter);
  const Input* culprit() const { return culprit_; }

  /// After evaluate(): values and their derivatives by the parameter, one for each input.
  const Eigen::VectorXd& value() const { return at_.input; }
  const Eigen::VectorXd& rate() const { return at_.input_rate; }
  const Eigen::VectorXd& acceleration() const { return at_.input_acceleration; }
  double time() const { return at_.time; }
  double time_rate() const { return time_rate_; }

  bool by_drives() const { return by_drives_; }
  /// The parameter's change while the inputs move by an angle of one, or a length of the scene: makes the parameter as
  /// large as an angle.
  double scale() const { return scale_; }

 private:
  explicit InputWay(const Mechanism& mechanism) : mechanism_(&mechanism), at_(mechanism) {}
  void set_scale(const Eigen::VectorXd& change, double during);

  const Mechanism* mechanism_;
  State at_;
  Eigen::VectorXd from_;
  double time_from_ = 0.0, time_rate_ = 1.0;
  double scale_ = 1.0;
  bool by_drives_ = true;
  const Input* culprit_ = nullptr;
};

/// Whether the state was closed for what the drives say at its last closed position, and asks for what they say at its
/// time: then the way between is theirs.
bool drives_lead(const Mechanism& mechanism, const State& state);

}  // namespace koppel
