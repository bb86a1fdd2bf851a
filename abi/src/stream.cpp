#include "boundary.hpp"
#include "stream/publisher.hpp"

namespace {

koppel::StreamModel stream_model(const koppel::Mechanism& m) {
  koppel::StreamModel model;
  model.scene = m.name;
  model.title = m.title;
  const koppel_version version = koppel_library_version();
  model.version =
      std::to_string(version.major) + "." + std::to_string(version.minor) + "." + std::to_string(version.patch);
  model.length = m.length;
  model.hash = m.hash;
  for (const koppel::NamedNumber& c : m.coordinate_names) model.coordinates.push_back({c.name, c.unit});
  for (const koppel::NamedNumber& r : m.rate_names) model.rates.push_back({r.name, r.unit});
  for (const koppel::Joint& joint : m.joints) model.joints.push_back(joint.name);
  for (const koppel::Body& body : m.bodies) model.bodies.push_back(body.name);
  return model;
}

koppel::ClosureFigures figures_of(const koppel_report& report) {
  koppel::ClosureFigures figures;
  figures.verdict = report.verdict;
  figures.solver = report.solver;
  figures.iterations = report.iterations;
  figures.rank = report.rank;
  figures.equations = report.equations;
  figures.unknowns = report.unknowns;
  figures.residual = report.residual;
  figures.condition = report.condition;
  figures.coordinate_error = report.coordinate_error;
  return figures;
}

koppel::Severity severity_of(std::int32_t severity) {
  if (severity <= KOPPEL_SEVERITY_NOTE) return koppel::Severity::note;
  return severity == KOPPEL_SEVERITY_WARNING ? koppel::Severity::warning : koppel::Severity::error;
}

}  // namespace

koppel_status koppel_stream_open(const koppel_mechanism* mechanism, const koppel_stream_options* options,
                                 koppel_stream** stream, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (mechanism == nullptr || stream == nullptr) {
      return koppel::invalid_argument("mechanism or stream is NULL", error);
    }
    const koppel_stream_options given = koppel::read_struct(options);
    koppel::StreamOptions wanted;
    if (given.url != nullptr) wanted.url = given.url;
    if (given.name != nullptr) wanted.name = given.name;
    wanted.period = given.period;
    auto publisher = koppel::Publisher::open(stream_model(*mechanism->mechanism), wanted, mechanism->log);
    if (!publisher) return koppel::fail(publisher.error(), error);
    const std::size_t numbers = 12 * mechanism->mechanism->bodies.size();
    *stream = new koppel_stream{mechanism->mechanism, std::move(*publisher), std::vector<double>(numbers)};
    return KOPPEL_OK;
  });
}

koppel_status koppel_stream_publish(koppel_stream* stream, const koppel_state* state, koppel_work* work,
                                    const koppel_report* report) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (stream == nullptr || state == nullptr || state->mechanism != stream->mechanism) return KOPPEL_INVALID_ARGUMENT;
    const koppel_status posed = koppel_poses(state, work, KOPPEL_KIND_BODY, stream->poses.data(), stream->poses.size());
    if (posed < 0) return posed;
    koppel::Snapshot snapshot;
    snapshot.time = state->state.time;
    const auto span = [](const Eigen::VectorXd& x) {
      return std::span<const double>(x.data(), static_cast<std::size_t>(x.size()));
    };
    snapshot.q = span(state->state.q);
    snapshot.v = span(state->state.v);
    snapshot.a = span(state->state.a);
    snapshot.poses = stream->poses;
    koppel::ClosureFigures figures;
    if (report != nullptr) {
      figures = figures_of(koppel::read_struct(report));
      snapshot.closure = &figures;
    }
    const auto published = stream->publisher->publish(snapshot);
    return published ? KOPPEL_OK : koppel::status_of(published.error().code);
  });
}

koppel_status koppel_stream_event(koppel_stream* stream, double time, int32_t severity, const char* text) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (stream == nullptr || text == nullptr) return KOPPEL_INVALID_ARGUMENT;
    const auto sent = stream->publisher->event(time, severity_of(severity), text);
    return sent ? KOPPEL_OK : koppel::status_of(sent.error().code);
  });
}

koppel_status koppel_stream_close(koppel_stream* stream, koppel_stream_statistics* statistics) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    const std::unique_ptr<koppel_stream> owned(stream);
    if (owned == nullptr) return KOPPEL_OK;
    const auto closed = owned->publisher->close();
    if (!closed) return koppel::status_of(closed.error().code);
    if (statistics != nullptr) {
      koppel_stream_statistics out{};
      out.published = closed->published;
      out.sent = closed->sent;
      out.dropped = closed->dropped;
      out.failed = closed->failed;
      koppel::write_struct(out, statistics);
    }
    return KOPPEL_OK;
  });
}
