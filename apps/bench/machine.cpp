#include "bench/machine.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include <malloc.h>
#include <sys/utsname.h>

#include "koppel/koppel.h"

namespace koppel::app::bench {
namespace {

/// What follows "key ... :" in a file of lines; empty if there is no such line.
std::string line_of(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return {};
}

/// What this process has taken from the heap and not given back [bytes].
double allocated() {
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
}

}  // namespace

Json machine() {
  utsname system{};
  uname(&system);
  const koppel_version version = koppel_library_version();
  const std::string processor = line_of("/proc/cpuinfo", "model name");
  return {{"processor", processor.empty() ? system.machine : processor},
          {"cores", std::thread::hardware_concurrency()},
          {"system", std::string(system.sysname) + ' ' + system.release},
          {"compiler", KOPPEL_COMPILER},
          {"flags", KOPPEL_FLAGS},
          {"koppel",
           std::to_string(version.major) + '.' + std::to_string(version.minor) + '.' + std::to_string(version.patch)}};
}

Json load() {
  std::array<double, 1> load{};
  return getloadavg(load.data(), 1) == 1 ? Json(load[0]) : Json(nullptr);
}

double yardstick() {
  const Stopwatch watch;
  double x = 0.5;
  for (int i = 0; i < 200000; ++i) x = std::sqrt(1.0 + 0.5 * x * x);
  volatile double kept = x;
  static_cast<void>(kept);
  return watch.seconds();
}

Json memory_of(const std::function<std::shared_ptr<void>()>& make) {
  make();  // what is kept for good from the first time on is not counted
  const double before = allocated();
  const std::shared_ptr<void> kept = make();
  const double taken = allocated() - before;
  return kept && taken > 0.0 ? Json(taken) : Json(nullptr);
}

}  // namespace koppel::app::bench
