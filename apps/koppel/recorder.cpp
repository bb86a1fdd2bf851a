#include "koppel/recorder.hpp"

#include <cstdio>

namespace koppel::app {

CLI::Option* add_recorder_options(CLI::App& command, RecorderOptions& options, const std::string& table) {
  CLI::Option* csv = command.add_option("--csv", options.csv, table)->check(not_empty)->type_name("FILE");
  CLI::Option* lcm =
      command
          .add_option("--lcm", options.lcm, "Stream to an LCM provider, for example udpm://239.255.76.67:7667?ttl=0")
          ->check(not_empty)
          ->type_name("URL");
  command.add_option("--log", options.log, "Keep the stream in an LCM log")
      ->excludes(lcm)
      ->check(not_empty)
      ->type_name("FILE");
  command.add_option("--name", options.name, "Channels are KOPPEL_<NAME>_STATE and so on; default: the scene's name")
      ->check(not_empty)
      ->type_name("NAME");
  return csv;
}

Recorder::Recorder(const Model& model, const RecorderOptions& options, std::vector<std::string> more)
    : model_(model), options_(options), more_(std::move(more)), records_(model.sizes().records) {}

koppel_status Recorder::open() {
  if (!options_.csv.empty()) {
    std::vector<std::string> columns = model_.names(KOPPEL_KIND_RECORD, records_);
    columns.insert(columns.begin(), "time");
    columns.insert(columns.end(), more_.begin(), more_.end());
    table_.emplace(options_.csv, columns);
    if (!table_->good()) return system_error("cannot write " + options_.csv);
  }
  const std::string url = options_.log.empty() ? options_.lcm : "file://" + options_.log + "?mode=w";
  if (url.empty()) return KOPPEL_OK;
  auto stream_options = sized<koppel_stream_options>();
  stream_options.url = url.c_str();
  stream_options.name = options_.name.empty() ? nullptr : options_.name.c_str();
  koppel_stream* stream = nullptr;
  const koppel_status status = koppel_stream_open(model_.mechanism.get(), &stream_options, &stream, &error_);
  stream_.reset(stream);
  streamed_ = status >= 0;
  return status;
}

koppel_status Recorder::write(const Motion& motion, double time, const koppel_report* report,
                              const std::vector<double>& more) {
  if (stream_) {
    const koppel_status status = koppel_stream_publish(stream_.get(), motion.state.get(), motion.work.get(), report);
    if (status < 0) return status;
  }
  if (!table_) return KOPPEL_OK;
  row_.assign(records_ + 1, time);
  row_.insert(row_.end(), more.begin(), more.end());
  const koppel_status status = koppel_records(motion.state.get(), motion.work.get(), row_.data() + 1, records_);
  if (status >= 0) table_->row(row_);
  return status;
}

koppel_status Recorder::close() {
  if (stream_ && koppel_stream_close(stream_.release(), &statistics_) < 0) {
    return system_error("the stream could not be finished");
  }
  if (table_ && !table_->good()) return system_error("cannot write " + options_.csv);
  return KOPPEL_OK;
}

koppel_status Recorder::system_error(const std::string& message) {
  error_ = sized<koppel_error>();
  error_.status = KOPPEL_IO;
  error_.severity = KOPPEL_SEVERITY_ERROR;
  std::snprintf(error_.message, sizeof error_.message, "%s", message.c_str());
  return KOPPEL_IO;
}

void Recorder::print(std::FILE* out) const {
  if (!streamed_) return;
  std::fprintf(out, "stream      %llu states sent, %llu dropped\n", static_cast<unsigned long long>(statistics_.sent),
               static_cast<unsigned long long>(statistics_.dropped));
}

void Recorder::write(nlohmann::ordered_json& document) const {
  if (!streamed_) return;
  document["stream"] = {
      {"published", statistics_.published}, {"sent", statistics_.sent}, {"dropped", statistics_.dropped}};
}

}  // namespace koppel::app
