#include "stream/publisher.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

#include <spdlog/logger.h>

#include "stream/encoder.hpp"
#include "stream/log_sink.hpp"
#include "stream/network_sink.hpp"
#include "stream/outbox.hpp"
#include "stream/url.hpp"

namespace koppel {
namespace {

using std::chrono::duration_cast, std::chrono::microseconds;

constexpr std::int64_t model_period = 1'000'000;  // [us]
constexpr std::int64_t flush_period = 100'000;    // [us]
constexpr microseconds longest_sleep{100'000};    // so that models and flushes come in time
constexpr std::size_t longest_name = 48;          // LCM allows channels of 63 bytes

std::int64_t wall_clock() {
  return duration_cast<microseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

tl::unexpected<Error> failure(Code code, std::string element, std::string message, std::string advice = {}) {
  Error error;
  error.code = code;
  error.element = std::move(element);
  error.message = std::move(message);
  error.advice = std::move(advice);
  return tl::make_unexpected(std::move(error));
}

/// The NAME in KOPPEL_<NAME>_STATE, if the options are sound.
Result<std::string> checked_name(const StreamOptions& options, const std::string& scene) {
  if (!std::isfinite(options.period) || options.period < 0)
    return failure(Code::invalid_argument, "stream", "the period is not a time", "give seconds, 0 for every state");
  std::string name = options.name;
  if (name.empty()) {
    name = scene;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
  }
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (name.empty() || name.size() > longest_name || !std::all_of(name.begin(), name.end(), plain))
    return failure(Code::stream_name, "stream", "`" + name + "` cannot become part of a channel's name",
                   "use 1 to 48 letters, digits and underscores");
  for (char& c : name)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return name;
}

Result<std::unique_ptr<Sink>> open_sink(const std::string& text) {
  KOPPEL_TRY(const ProviderUrl url, read_provider_url(text));
  if (url.kind == ProviderUrl::Kind::log) return LogSink::open(url);
  return NetworkSink::open(url);
}

/// Keeps the host's signals away from a thread that starts in this scope: they are for the host's own threads. Those of
/// faults stay, since they concern the thread that made them.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t blocked;
    sigfillset(&blocked);
    for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) sigdelset(&blocked, fault);
    pthread_sigmask(SIG_SETMASK, &blocked, &before_);
  }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

}  // namespace

std::int64_t steady_clock() {
  return duration_cast<microseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// All that the host and the sending thread share, and the thread.
class Publisher::Worker {
 public:
  Worker(StreamModel model, const std::string& name, double period, std::unique_ptr<Sink> sink, Logger logger,
         Clock clock)
      : model_(std::move(model)),
        period_(static_cast<std::int64_t>(std::min(period, 1e9) * 1e6)),
        sink_(std::move(sink)),
        logger_(std::move(logger)),
        clock_(std::move(clock)),
        encoder_(model_, name),
        outbox_(model_, sink_->lossless()) {}

  void start() {
    const SignalsBlocked blocked;
    thread_ = std::thread([this] {
      try {
        run();
      } catch (...) {  // no memory, or the host's log: the stream ends, the process does not
        broken_.store(true, std::memory_order_relaxed);
        outbox_.give_up();
      }
    });
  }
  void join() {
    outbox_.close();
    if (thread_.joinable()) thread_.join();
  }

  const StreamModel& model() const { return model_; }
  Outbox& outbox() { return outbox_; }
  /// The log is broken: what was sent from then on is lost.
  bool broken() const { return broken_.load(std::memory_order_relaxed); }
  /// Only when the thread has ended.
  StreamStatistics statistics() const { return {outbox_.published(), sent_, outbox_.dropped(), failed_}; }

 private:
  void run();
  void keep_periods();
  void send(const Slot& slot);
  void note_failure(bool fine);

  const StreamModel model_;
  const std::int64_t period_;  // [us]
  const std::unique_ptr<Sink> sink_;
  const Logger logger_;
  const Clock clock_;
  Encoder encoder_;
  Outbox outbox_;
  std::thread thread_;
  std::atomic<bool> broken_ = false;
  // Only the thread's while it runs.
  std::int64_t model_due_ = 0;
  std::int64_t flush_due_ = 0;
  std::int64_t state_due_ = 0;
  std::uint64_t sent_ = 0;
  std::uint64_t failed_ = 0;
  bool complained_ = false;
};

void Publisher::Worker::run() {
  model_due_ = state_due_ = clock_();
  flush_due_ = model_due_ + flush_period;
  for (;;) {
    keep_periods();
    const std::int64_t pause = sink_->lossless() ? 0 : std::max<std::int64_t>(0, state_due_ - clock_());
    const auto sleep = pause > 0 ? std::min(longest_sleep, microseconds(pause)) : longest_sleep;
    const Outbox::Item item = outbox_.take(pause == 0, sleep);
    if (const auto* slot = std::get_if<const Slot*>(&item)) send(**slot);
    if (const auto* event = std::get_if<Event>(&item)) note_failure(encoder_.send(*sink_, *event));
    if (std::holds_alternative<Outbox::Closed>(item)) break;
  }
  note_failure(sink_->flush());
}

void Publisher::Worker::keep_periods() {
  const std::int64_t now = clock_();
  if (now >= model_due_) {
    note_failure(encoder_.send_model(*sink_, wall_clock()));
    model_due_ = now + model_period;
  }
  if (now >= flush_due_) {
    note_failure(sink_->flush());
    flush_due_ = now + flush_period;
  }
}

void Publisher::Worker::send(const Slot& slot) {
  state_due_ = clock_() + period_;
  const bool fine = encoder_.send(*sink_, slot);
  ++(fine ? sent_ : failed_);
  note_failure(fine);
}

void Publisher::Worker::note_failure(bool fine) {
  if (fine || complained_) return;
  complained_ = true;
  if (sink_->lossless()) {
    broken_.store(true, std::memory_order_relaxed);
    outbox_.give_up();
    logger_->error("stream: the log cannot be written any further");
  } else {
    logger_->warn("stream: LCM could not send a message; further failures are only counted");
  }
}

Publisher::Publisher(std::unique_ptr<Worker> worker) : worker_(std::move(worker)) {}

Publisher::~Publisher() { worker_->join(); }

Result<std::unique_ptr<Publisher>> Publisher::open(StreamModel model, const StreamOptions& options, Logger logger) {
  // Checked before the sink is opened: a bad option must not leave an emptied log behind.
  KOPPEL_CHECK(checked_name(options, model.scene));
  KOPPEL_TRY(std::unique_ptr<Sink> sink, open_sink(options.url));
  return open(std::move(model), options, std::move(sink), std::move(logger));
}

Result<std::unique_ptr<Publisher>> Publisher::open(StreamModel model, const StreamOptions& options,
                                                   std::unique_ptr<Sink> sink, Logger logger, Clock clock) {
  KOPPEL_TRY(const std::string name, checked_name(options, model.scene));
  auto worker = std::make_unique<Worker>(std::move(model), name, options.period, std::move(sink), std::move(logger),
                                         std::move(clock));
  try {
    worker->start();
  } catch (const std::system_error& error) {
    return failure(Code::stream_failed, "stream " + name, std::string("the system gives no thread: ") + error.what());
  }
  return std::unique_ptr<Publisher>(new Publisher(std::move(worker)));
}

Result<void> Publisher::publish(const Snapshot& snapshot) {
  const StreamModel& model = worker_->model();
  if (snapshot.q.size() != model.coordinates.size() || snapshot.v.size() != model.rates.size() ||
      snapshot.a.size() != model.rates.size() || snapshot.poses.size() != 12 * model.bodies.size())
    return failure(Code::invalid_argument, "stream", "the snapshot has other sizes than the stream's model");
  if (worker_->outbox().closed()) return failure(Code::invalid_argument, "stream", "it is closed");
  worker_->outbox().put(snapshot, wall_clock());
  if (worker_->broken()) return failure(Code::stream_failed, "stream", "the log cannot be written any further");
  return {};
}

Result<void> Publisher::event(double time, Severity severity, std::string_view text) {
  if (worker_->outbox().closed()) return failure(Code::invalid_argument, "stream", "it is closed");
  worker_->outbox().put(Event{wall_clock(), 0, time, severity, std::string(text)});
  if (worker_->broken()) return failure(Code::stream_failed, "stream", "the log cannot be written any further");
  return {};
}

Result<StreamStatistics> Publisher::close() {
  worker_->join();
  if (worker_->broken()) return failure(Code::stream_failed, "stream", "the log is incomplete");
  return worker_->statistics();
}

}  // namespace koppel
