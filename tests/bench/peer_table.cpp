#include "peer_table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

namespace koppel::bench {
namespace {

double median(std::vector<double> sample) {
  std::sort(sample.begin(), sample.end());
  return 0.5 * (sample[(sample.size() - 1) / 2] + sample[sample.size() / 2]);
}

}  // namespace

std::string output_of(const std::string& command) {
  std::string bytes;
  std::FILE* const pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (!pipe) return bytes;
  std::array<char, 65536> part{};
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe)) bytes.append(part.data(), size);
  return pclose(pipe) == 0 ? bytes : std::string();
}

std::vector<PeerProgram> peer_programs() {
  std::vector<PeerProgram> programs;
  const std::string folder = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
  for (const char* const name : {"simbody", "mujoco", "dart"}) {
    const std::string command = std::string("'").append(folder).append("/koppel_peer_").append(name).append("'");
    const auto can = nlohmann::json::parse(output_of(command), nullptr, false);
    if (can.is_object()) {
      programs.push_back({can["engine"].get<std::string>(), command});
    } else {
      std::printf("without %s: its program was not built\n", name);
    }
  }
  return programs;
}

void Row::show(const std::string& problem, const std::string& what, const std::string& engine, double allowed) const {
  std::printf("%-12s %-17s %-18s", problem.c_str(), what.c_str(), engine.c_str());
  if (seconds.empty()) {
    std::printf(" does not take it\n");
    return;
  }
  if (!(error < allowed)) {
    std::printf(" does not compute the same: error %.1e\n", error);
    return;
  }
  const auto [least, greatest] = std::minmax_element(seconds.begin(), seconds.end());
  std::printf("%10.3f us (%.3f to %.3f)  %6.2f times koppel's  ", 1e6 * median(seconds), 1e6 * *least, 1e6 * *greatest,
              median(ratios));
  if (is_measure) {
    std::printf("the others are compared with it\n");
  } else {
    std::printf("error %.1e\n", error);
  }
}

}  // namespace koppel::bench
