#include "koppel/checkpoint.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace koppel::app {
namespace {

koppel_status system_error(const std::string& message, koppel_error& error) {
  error = sized<koppel_error>();
  error.status = KOPPEL_IO;
  error.severity = KOPPEL_SEVERITY_ERROR;
  std::snprintf(error.code, sizeof error.code, "%s", "E0101");
  std::snprintf(error.message, sizeof error.message, "%s", message.c_str());
  return KOPPEL_IO;
}

}  // namespace

koppel_status write_checkpoint(koppel_simulation* simulation, const std::string& file, koppel_error& error) {
  std::size_t size = 0;
  koppel_status status = koppel_simulation_save(simulation, nullptr, 0, &size, &error);
  if (status < 0) return status;
  std::vector<char> bytes(size);
  status = koppel_simulation_save(simulation, bytes.data(), bytes.size(), &size, &error);
  if (status < 0) return status;
  const std::string part = file + ".part";
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  std::error_code problem;
  if (out) std::filesystem::rename(part, file, problem);
  if (out && !problem) return KOPPEL_OK;
  return system_error("cannot write " + file + ": " + (problem ? problem.message() : std::strerror(errno)), error);
}

koppel_status read_checkpoint(const Model& model, const std::string& file, Simulation& simulation,
                              koppel_error& error) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return system_error("cannot read " + file + ": " + std::strerror(errno), error);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  koppel_simulation* loaded = nullptr;
  const koppel_status status =
      koppel_simulation_load(model.mechanism.get(), bytes.data(), bytes.size(), &loaded, &error);
  if (status >= 0) simulation.reset(loaded);
  return status;
}

}  // namespace koppel::app
