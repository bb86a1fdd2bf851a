#include "bench/sampler.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <execinfo.h>
#include <unistd.h>

#include "bench/rounds.hpp"

namespace koppel::app::bench {
namespace {

constexpr long period = 250000;  // [ns] between two looks
constexpr int deepest = 64;      // functions of a stack, from the innermost on

using Stack = std::array<void*, deepest>;

/// What the signal handler writes into; it may not allocate.
struct Looks {
  std::vector<Stack> stacks;
  std::size_t taken = 0;
  long computed = 0;  ///< [ns] by the thread until the last look
};
Looks* looks = nullptr;

/// Of the thread that asks [ns].
long time_computed() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1000000000L * time.tv_sec + time.tv_nsec;
}

void look(int /*signal*/) {
  // Not where the thread only waited for the processor meanwhile.
  const long computed = time_computed();
  if (computed - looks->computed < period / 2 || looks->taken == looks->stacks.size()) return;
  looks->computed = computed;
  Stack& stack = looks->stacks[looks->taken++];
  const int depth = backtrace(stack.data(), deepest);
  if (depth < deepest) stack[static_cast<std::size_t>(depth)] = nullptr;
}

/// Looks as long as it lives.
class Timer {
 public:
  explicit Timer(Looks& into) {
    looks = &into;
    looks->computed = time_computed();
    Stack first;
    backtrace(first.data(), deepest);  // loads what it needs before a signal comes
    struct sigaction action = {};
    action.sa_handler = look;
    action.sa_flags = SA_RESTART;
    sigaction(SIGPROF, &action, &before_);
    sigevent event = {};
    event.sigev_notify = SIGEV_THREAD_ID;  // no other thread has anything to tell
    event._sigev_un._tid = gettid();
    event.sigev_signo = SIGPROF;
    runs_ = timer_create(CLOCK_MONOTONIC, &event, &timer_) == 0;
    const itimerspec often = {{0, period}, {0, period}};
    if (runs_) timer_settime(timer_, 0, &often, nullptr);
  }
  ~Timer() {
    if (runs_) timer_delete(timer_);
    // One may still be on its way.
    std::signal(SIGPROF, SIG_IGN);
    sigaction(SIGPROF, &before_, nullptr);
  }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  timer_t timer_ = {};
  bool runs_ = false;
  struct sigaction before_ = {};
};

/// The functions of koppel's library, from its symbol table: most of them are not exported.
class Functions {
 public:
  Functions() {
    Dl_info info = {};
    void* const entry = dlsym(RTLD_DEFAULT, "koppel_move");
    if (!entry || dladdr(entry, &info) == 0) return;
    library_ = info.dli_fname;
    base_ = reinterpret_cast<std::uintptr_t>(info.dli_fbase);
    std::FILE* const pipe = popen(("nm -C --defined-only '" + library_ + "' 2>/dev/null").c_str(), "r");
    if (!pipe) return;
    char* line = nullptr;
    std::size_t size = 0;
    while (getline(&line, &size, pipe) > 0) take(line);
    std::free(line);
    pclose(pipe);
  }

  bool known() const { return !names_.empty(); }

  /// Name of the function at an address; of those in other libraries, the library's file.
  std::string at(void* address) const {
    Dl_info info = {};
    if (dladdr(address, &info) == 0 || !info.dli_fname) return {};
    if (library_ != info.dli_fname) return info.dli_fname;
    // What is returned to lies behind the call.
    const auto after = names_.lower_bound(reinterpret_cast<std::uintptr_t>(address) - base_);
    return after == names_.begin() ? std::string() : std::prev(after)->second;
  }

 private:
  /// A line as "00000000000f3a10 t koppel::Joint::pose(double const*) const".
  void take(const std::string& line) {
    const std::size_t kind = line.find(' ') + 1;
    if (kind + 2 >= line.size() || std::string_view("tTwWiu").find(line[kind]) == std::string_view::npos) return;
    const std::size_t end = line.find_last_not_of('\n');
    names_.emplace(std::strtoull(line.c_str(), nullptr, 16), line.substr(kind + 2, end - kind - 1));
  }

  std::string library_;
  std::uintptr_t base_ = 0;
  std::map<std::uintptr_t, std::string> names_;
};

/// A part has the functions whose names hold one of the words; what is nobody's is its caller's.
struct Part {
  const char* name;
  std::vector<std::string_view> words;
};

const std::vector<Part>& parts() {
  static const std::vector<Part> table = {
      {"plugins", {"koppel::plugin::"}},
      {"kinematics", {"koppel::forward_position", "koppel::forward_motion", "koppel::Joint::", "koppel::FrameMotion"}},
      {"closure",
       {"koppel::Equations::", "koppel::Face::", "koppel::Closing::", "koppel::newton", "koppel::close",
        "koppel::velocities", "koppel::accelerations"}},
      {"closed forms", {"koppel::FlowTracker::", "koppel::FlowSolver::"}},
      {"linear algebra",
       {"Factorisation",
        "koppel::Elimination::",
        "Eigen::internal::gebp",
        "Eigen::internal::gemm",
        "Eigen::internal::general_matrix",
        "Eigen::internal::triangular",
        "Eigen::internal::householder",
        "Eigen::MatrixBase",
        "HouseholderQR",
        "Eigen::JacobiSVD",
        "Eigen::BDCSVD",
        "Eigen::LLT",
        "Eigen::LDLT",
        "PivLU",
        "Eigen::internal::partial_lu",
        "Eigen::internal::llt",
        "Eigen::internal::ldlt",
        "libblas",
        "liblapack",
        "libcholmod",
        "libopenblas"}},
      {"Ceres", {"ceres::"}},
      {"dynamics",
       {"koppel::EquationsOfMotion::", "koppel::MassMatrix::", "koppel::ArticulatedBodies::", "FactoredDynamics::",
        "koppel::inverse_dynamics", "koppel::Forces::", "Equation::", "koppel::RungeKutta",
        "koppel::Simulation::", "koppel::ClosureRows::", "koppel::Chart::", "koppel::mechanical_state", "libsundials"}},
      {"streaming",
       {"koppel::Publisher::", "koppel::Outbox::", "koppel::Encoder::", "Sink::", "koppel_stream", "liblcm"}},
      {"other", {}},
  };
  return table;
}

/// The part of a function; the last one if it has none.
std::size_t part_of(const std::string& function) {
  constexpr std::string_view unnamed = "(anonymous namespace)::";
  std::string name = function;
  for (std::size_t at = name.find(unnamed); at != std::string::npos; at = name.find(unnamed))
    name.erase(at, unnamed.size());
  name.erase(std::min(name.find('('), name.size()));
  const auto holds = [&name](std::string_view word) { return name.find(word) != std::string::npos; };
  const auto found = std::find_if(parts().begin(), parts().end(), [&](const Part& part) {
    return std::any_of(part.words.begin(), part.words.end(), holds);
  });
  return static_cast<std::size_t>(std::min(found, parts().end() - 1) - parts().begin());
}

std::size_t part_of(const Stack& stack, const Functions& functions) {
  const std::size_t none = parts().size() - 1;
  for (void* const address : stack) {
    if (!address) break;
    const std::size_t part = part_of(functions.at(address));
    if (part != none) return part;
  }
  return none;
}

}  // namespace

const std::vector<std::string>& profile_parts() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Part& part : parts()) all.emplace_back(part.name);
    return all;
  }();
  return names;
}

Samples sample(const std::function<bool()>& work, double seconds) {
  static const Functions functions;
  Samples samples;
  samples.counts.assign(parts().size(), 0);
  if (!functions.known()) {
    samples.problem = "the functions of koppel's library have no names: nm (binutils) is missing, or they are stripped";
    return samples;
  }
  Looks taken;
  taken.stacks.resize(static_cast<std::size_t>(2e9 * seconds / period));
  {
    const Timer timer(taken);
    for (const Stopwatch watch; watch.seconds() < seconds; ++samples.runs) {
      if (work()) continue;
      samples.problem = "the scene does not move through its run";
      break;
    }
  }
  for (std::size_t i = 0; i < taken.taken; ++i) ++samples.counts[part_of(taken.stacks[i], functions)];
  return samples;
}

}  // namespace koppel::app::bench
