#include "dynamics/linearisation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "dynamics/eigenmodes.hpp"
#include "dynamics/minimal_equation.hpp"
#include "dynamics/reactions.hpp"
#include "dynamics/statics.hpp"
#include "mechanism/records.hpp"

namespace koppel {
namespace {

constexpr double steady_part = 1e-9;  // of the greatest entries of A below which a change of rates is none

Derivative block(const Derivative& whole, Eigen::Index row, Eigen::Index column, Eigen::Index rows,
                 Eigen::Index columns) {
  return {whole.value.block(row, column, rows, columns), whole.error.block(row, column, rows, columns)};
}

Derivative times(const Eigen::MatrixXd& factor, const Derivative& of) {
  return {factor * of.value, factor.cwiseAbs() * of.error};
}

/// Recorded columns that vary smoothly with the state: no axes, which have no place at rest, nor transfer functions.
std::vector<std::uint32_t> output_columns(const Mechanism& mechanism) {
  std::vector<std::uint32_t> columns;
  for (std::uint32_t i = 0; i < mechanism.record_columns.size(); ++i) {
    const RecordDescription& record = mechanism.records[mechanism.record_columns[i].record];
    const bool axode = record.quantity == Quantity::fixed_axode || record.quantity == Quantity::moving_axode;
    if (!record.by && !axode) columns.push_back(i);
  }
  return columns;
}

/// The motion near a state, as functions of deviations x and u.
class Neighbourhood {
 public:
  Neighbourhood(std::shared_ptr<const Mechanism> mechanism, Inertias bodies, const State& state,
                const LinearisationOptions& options)
      : mechanism_(mechanism),
        motion_(mechanism, std::move(bodies)),
        equation_(motion_),
        shown_(state),
        efforts_(options.efforts),
        time_(state.time),
        push_(Eigen::VectorXd::Zero(mechanism->nv)),
        outputs_(output_columns(*mechanism)),
        recorded_(static_cast<Eigen::Index>(mechanism->record_columns.size())) {
    motion_.hold_drives(options.held);
    if (mechanism->records_loads) reactions_.emplace(mechanism, motion_.inertias());
  }

  EquationsOfMotion& motion() { return motion_; }
  Eigen::Index freedoms() const { return static_cast<Eigen::Index>(motion_.independent().size()); }
  Eigen::Index size() const { return 2 * freedoms() + mechanism_->internal_start.size(); }
  Eigen::Index drives() const { return static_cast<Eigen::Index>(mechanism_->inputs.size()); }
  Eigen::Index outputs() const { return static_cast<Eigen::Index>(outputs_.size()); }
  Eigen::Index inputs() const { return 3 * drives() + static_cast<Eigen::Index>(efforts_.size()); }

  bool start(const Eigen::VectorXd& v) {
    return equation_.start(shown_.q, v, time_, shown_.internal, y0_) && follow_rates();
  }

  /// x' and recorded columns one after the other, at x and u.
  bool evaluate(const Eigen::VectorXd& x, const Eigen::VectorXd& u, Eigen::VectorXd& out) {
    const Eigen::Index f = freedoms(), nv = mechanism_->nv, states = mechanism_->internal_start.size();
    put_in(u);
    y_ = y0_;
    for (Eigen::Index i = 0; i < f; ++i) y_[coordinate(i)] += x[i];
    y_.segment(nv, f + states) += x.tail(f + states);
    const bool there = equation_.rate(time_, y_, y_rate_);
    put_in(Eigen::VectorXd::Zero(inputs()));
    if (!there || !motion_.complete(shown_.a)) return false;
    shown_.q = motion_.q();
    shown_.v = motion_.v();
    shown_.internal = y_.segment(nv + f, states);
    if (reactions_ && !reactions_->evaluate(shown_)) return false;
    out.resize(size() + outputs());
    for (Eigen::Index i = 0; i < f; ++i) out[i] = y_rate_[coordinate(i)];
    out.segment(f, f + states) = y_rate_.segment(nv, f + states);
    evaluate_records(*mechanism_, shown_, motion_.kinematics(), reactions_ ? &reactions_->loads() : nullptr,
                     std::nullopt, recorded_.data());
    out.tail(outputs()) = recorded_(outputs_);
    return true;
  }

  /// What counts as one in x, and in u: of an effort, what accelerates its coordinate by one.
  Eigen::VectorXd x_scales() const {
    Eigen::VectorXd scales = Eigen::VectorXd::Ones(size());
    for (Eigen::Index i = 0; i < freedoms(); ++i) scales[i] = scales[freedoms() + i] = scale(coordinate(i));
    return scales;
  }
  Eigen::VectorXd u_scales(const Eigen::MatrixXd& mass) const {
    Eigen::VectorXd scales = Eigen::VectorXd::Ones(inputs());
    for (Eigen::Index i = 0; i < drives(); ++i) {
      scales.segment<3>(3 * i).setConstant(scale(mechanism_->inputs[static_cast<std::size_t>(i)].v));
    }
    for (std::size_t i = 0; i < efforts_.size(); ++i) {
      const Eigen::VectorXd lever = follow_.row(efforts_[i]);
      const double answer = lever.dot(mass.llt().solve(lever));
      if (answer > 0.0) scales[3 * drives() + static_cast<Eigen::Index>(i)] = scale(efforts_[i]) / answer;
    }
    return scales;
  }
  /// How all rates follow from the independent ones.
  const Eigen::MatrixXd& follow() const { return follow_; }

 private:
  std::uint32_t coordinate(Eigen::Index i) const { return motion_.independent()[static_cast<std::size_t>(i)]; }
  double scale(std::uint32_t v) const { return mechanism_->rate_scale[v]; }

  void put_in(const Eigen::VectorXd& u) {
    for (Eigen::Index i = 0; i < drives(); ++i) {
      motion_.offset_drive(static_cast<std::size_t>(i), u.segment<3>(3 * i));
    }
    // Along the independent coordinates, so that joints at which loops are cut take part.
    push_.setZero();
    for (std::size_t k = 0; k < efforts_.size(); ++k) {
      const double effort = u[3 * drives() + static_cast<Eigen::Index>(k)];
      for (Eigen::Index i = 0; i < freedoms(); ++i) push_[coordinate(i)] += effort * follow_(efforts_[k], i);
    }
    motion_.push(push_);
  }

  bool follow_rates() {
    const Eigen::Index f = freedoms();
    follow_.resize(mechanism_->nv, f);
    if (!equation_.place(time_, y0_) || !motion_.velocities(Eigen::VectorXd::Zero(f))) return false;
    const Eigen::VectorXd rest = motion_.v();
    for (Eigen::Index i = 0; i < f; ++i) {
      if (!motion_.velocities(Eigen::VectorXd::Unit(f, i))) return false;
      follow_.col(i) = motion_.v() - rest;
    }
    return true;
  }

  std::shared_ptr<const Mechanism> mechanism_;
  EquationsOfMotion motion_;
  MinimalEquation equation_;
  std::optional<Reactions> reactions_;  ///< if records ask for them
  State shown_;
  std::vector<std::uint32_t> efforts_;  ///< rates
  double time_;
  Eigen::VectorXd push_;
  std::vector<std::uint32_t> outputs_;  ///< record columns
  Eigen::VectorXd recorded_;            ///< all of them
  Eigen::MatrixXd follow_;
  Eigen::VectorXd y0_, y_, y_rate_;
};

/// "rad/s" to "rad".
std::string integrated(const std::string& unit) {
  return unit.size() > 2 && unit.ends_with("/s") ? unit.substr(0, unit.size() - 2) : unit;
}

void name_all(const Mechanism& m, const LinearisationOptions& options, Linearisation& result) {
  const auto unit_of = [&](std::uint32_t v) { return integrated(m.rate_names[v].unit); };
  for (const std::uint32_t v : result.independent) result.states.push_back({m.rate_names[v].name, unit_of(v)});
  for (const std::uint32_t v : result.independent) {
    result.states.push_back({m.rate_names[v].name + " rate", m.rate_names[v].unit});
  }
  for (const Force& force : m.forces) {
    for (const InternalState& state : force.type->states) {
      result.states.push_back({force.name + "." + state.name, state.unit});
    }
  }
  for (const Input& input : m.inputs) {
    const std::string& name = m.rate_names[input.v].name;
    result.inputs.push_back({name, unit_of(input.v)});
    result.inputs.push_back({name + " rate", m.rate_names[input.v].unit});
    result.inputs.push_back({name + " acceleration", m.rate_names[input.v].unit + "^2"});
  }
  for (const std::uint32_t v : options.efforts) {
    result.inputs.push_back({m.rate_names[v].name + " effort", unit_of(v) == "m" ? "N" : "N m"});
  }
  for (const std::uint32_t i : output_columns(m)) {
    result.outputs.push_back({m.record_columns[i].name, m.record_columns[i].unit});
  }
}

/// Whether the state changes, and its change.
void find_course(const Eigen::VectorXd& scales, Eigen::Index f, Linearisation& result) {
  const Eigen::VectorXd change = result.x_rate.cwiseQuotient(scales);
  const Eigen::MatrixXd a = scales.cwiseInverse().asDiagonal() * result.a.value * scales.asDiagonal();
  const double size = std::max(1.0, a.size() == 0 ? 0.0 : a.cwiseAbs().maxCoeff());
  const auto greatest = [](const Eigen::VectorXd& x) { return x.size() == 0 ? 0.0 : x.lpNorm<Eigen::Infinity>(); };
  result.drift = greatest(change.tail(change.size() - f));
  const Eigen::VectorXd second = a * change;
  const double limit = steady_part * size;
  if (result.drift <= limit && greatest(second) <= limit * std::max(1.0, greatest(change))) {
    result.course = greatest(change.head(f)) <= steady_part ? Course::resting : Course::steady;
  }
}

void find_modes(const Mechanism& m, const Eigen::MatrixXd& follow, const Eigen::VectorXd& scales,
                Linearisation& result) {
  // In scaled coordinates, so that metres and radians weigh alike.
  const Derivative scaled{scales.cwiseInverse().asDiagonal() * result.a.value * scales.asDiagonal(),
                          scales.cwiseInverse().asDiagonal() * result.a.error * scales.asDiagonal()};
  const Eigenmodes found = eigenmodes(scaled);
  const Eigen::Map<const Eigen::VectorXd> of_rates(m.rate_scale.data(), m.nv);
  for (Eigen::Index k = 0; k < found.values.size(); ++k) {
    NaturalMode mode;
    mode.eigenvalue = found.values[k];
    mode.error = found.errors[k];
    mode.state = scales.asDiagonal() * found.vectors.col(k);
    mode.shape = follow * mode.state.head(follow.cols());
    Eigen::Index greatest = 0;
    if (m.nv > 0) mode.shape.cwiseQuotient(of_rates).cwiseAbs().maxCoeff(&greatest);
    if (m.nv > 0 && std::abs(mode.shape[greatest]) > 0.0) {
      const std::complex<double> one = mode.shape[greatest] / of_rates[greatest];
      mode.shape /= one;
      mode.state /= one;
    }
    result.modes.push_back(std::move(mode));
  }
}

Error cannot(const EquationsOfMotion& motion, const std::string& beside) {
  switch (motion.obstacle()) {
    case Obstacle::plugin: return plugin_error(motion);
    case Obstacle::massless:
      return make_error(Code::massless, "coordinate " + motion.culprit(), "moves without any mass that resists",
                        "give the bodies that it moves a mass or an inertia, or drive it");
    case Obstacle::open:
    case Obstacle::singular:
    case Obstacle::none: break;
  }
  return make_error(Code::no_linearisation, motion.culprit(),
                    "the motion cannot be evaluated " + beside + ": the loops are at a singular position",
                    "linearise at another position");
}

}  // namespace

Result<Linearisation> linearise(std::shared_ptr<const Mechanism> mechanism, const State& state,
                                const LinearisationOptions& options) {
  KOPPEL_TRY(Inertias bodies, inertias(*mechanism));
  const Mechanism& m = *mechanism;
  Neighbourhood near(mechanism, std::move(bodies), state, options);
  const bool resting = options.held || state.stage < Stage::velocities;
  const Eigen::VectorXd v = resting ? Eigen::VectorXd(Eigen::VectorXd::Zero(m.nv)) : state.v;
  if (!near.start(v)) return tl::make_unexpected(cannot(near.motion(), "there"));
  Linearisation result;
  result.independent = near.motion().independent();
  name_all(m, options, result);
  const Eigen::Index f = near.freedoms(), n = near.size(), outputs = near.outputs();
  const Eigen::VectorXd x = Eigen::VectorXd::Zero(n), u = Eigen::VectorXd::Zero(near.inputs());
  Derivative by_x, by_u;
  Eigen::Index failed = -1;
  Eigen::VectorXd middle;
  if (!near.evaluate(x, u, middle)) return tl::make_unexpected(cannot(near.motion(), "there"));
  result.x_rate = middle.head(n);
  near.motion().mass(result.mass);
  const auto along_x = [&](const Eigen::VectorXd& at, Eigen::VectorXd& out) { return near.evaluate(at, u, out); };
  const auto along_u = [&](const Eigen::VectorXd& at, Eigen::VectorXd& out) { return near.evaluate(x, at, out); };
  if (!differentiate(along_x, x, near.x_scales(), by_x, failed)) {
    return tl::make_unexpected(
        cannot(near.motion(), "beside it along " + result.states[static_cast<std::size_t>(failed)].name));
  }
  if (!differentiate(along_u, u, near.u_scales(result.mass), by_u, failed)) {
    return tl::make_unexpected(
        cannot(near.motion(), "beside it along " + result.inputs[static_cast<std::size_t>(failed)].name));
  }
  result.a = block(by_x, 0, 0, n, n);
  result.c = block(by_x, n, 0, outputs, n);
  result.b = block(by_u, 0, 0, n, u.size());
  result.d = block(by_u, n, 0, outputs, u.size());
  result.stiffness = times(-result.mass, block(result.a, f, 0, f, f));
  result.damping = times(-result.mass, block(result.a, f, f, f, f));
  find_course(near.x_scales(), f, result);
  find_modes(m, near.follow(), near.x_scales(), result);
  return result;
}

}  // namespace koppel
