// Where the states of a motion go: a table of what the scene records, and an LCM stream or log.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/table.hpp"
#include "koppel/command.hpp"

namespace koppel::app {

struct RecorderOptions {
  std::string csv, lcm, log, name;
};

/// Gives them to a command; `options` must live as long. table: what the help says of --csv, which is returned.
CLI::Option* add_recorder_options(CLI::App& command, RecorderOptions& options, const std::string& table);

class Recorder {
 public:
  /// more: columns of the table after the recorded ones.
  Recorder(const Model& model, const RecorderOptions& options, std::vector<std::string> more = {});

  /// Opens table and stream. Below 0: the library could not, and error() tells why.
  koppel_status open();
  /// One state; more: as many numbers as there are columns of the caller's own. report: of its closure, or null.
  koppel_status write(const Motion& motion, double time, const koppel_report* report,
                      const std::vector<double>& more = {});
  /// Sends and writes what is still held back.
  koppel_status close();

  /// The library's words, or for what it does not know of (a table that cannot be written) our own.
  const koppel_error& error() const { return error_; }
  /// For people, and as "stream" in --json; nothing if there is no stream.
  void print(std::FILE* out) const;
  void write(nlohmann::ordered_json& document) const;

 private:
  koppel_status system_error(const std::string& message);

  const Model& model_;
  const RecorderOptions& options_;
  std::vector<std::string> more_;
  std::size_t records_;
  std::optional<Table> table_;
  std::vector<double> row_;
  Stream stream_;
  bool streamed_ = false;
  koppel_stream_statistics statistics_ = sized<koppel_stream_statistics>();
  koppel_error error_ = sized<koppel_error>();
};

}  // namespace koppel::app
