#include <cstdlib>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <lcm/eventlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include "example.hpp"
#include "koppel/event_t.hpp"
#include "koppel/model_t.hpp"
#include "koppel/state_t.hpp"
#include "stream/log_sink.hpp"

namespace koppel::test {
namespace {

/// A file that is removed with the object.
class TemporaryLog {
 public:
  TemporaryLog() {
    const int file = mkstemp(path_.data());
    EXPECT_GE(file, 0);
    ::close(file);
  }
  ~TemporaryLog() { std::filesystem::remove(path_); }
  std::string url() const { return "file://" + path_ + "?mode=w"; }
  std::uintmax_t size() const { return std::filesystem::file_size(path_); }

  /// All events, read by LCM itself.
  std::unique_ptr<Record> read() const {
    auto record = std::make_unique<Record>();
    lcm_eventlog_t* const log = lcm_eventlog_create(path_.c_str(), "r");
    std::int64_t number = 0;
    while (lcm_eventlog_event_t* const event = lcm_eventlog_read_next_event(log)) {
      EXPECT_EQ(event->eventnum, number++);
      record->add(event->channel,
                  {static_cast<const std::uint8_t*>(event->data), static_cast<std::size_t>(event->datalen)});
      lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    return record;
  }

 private:
  std::string path_ = std::filesystem::temp_directory_path() / "koppel_log_XXXXXX";
};

Result<std::unique_ptr<Publisher>> open(const std::string& url) {
  StreamOptions options;
  options.url = url;
  return Publisher::open(example_model(), options, silent_logger());
}

TEST(Log, HoldsEveryStateInOrder) {
  const TemporaryLog log;
  auto publisher = open(log.url());
  ASSERT_TRUE(publisher) << render(publisher.error());
  constexpr int count = 20'000;  // some megabytes: many times the buffers
  for (int n = 0; n < count; ++n) ASSERT_TRUE((*publisher)->publish(Numbers(n).snapshot()));
  ASSERT_TRUE((*publisher)->event(1, Severity::error, "the end"));
  const auto statistics = (*publisher)->close();
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->sent, static_cast<std::uint64_t>(count));

  const auto record = log.read();
  EXPECT_EQ(record->messages().front().first, "KOPPEL_FOUR_BAR_MODEL") << "a log begins with what explains it";
  EXPECT_EQ(record->messages().back().first, "KOPPEL_FOUR_BAR_EVENT");
  const auto states = record->all<state_t>("KOPPEL_FOUR_BAR_STATE");
  ASSERT_EQ(states.size(), static_cast<std::size_t>(count));
  for (int n = 0; n < count; ++n) {
    const state_t& state = states[static_cast<std::size_t>(n)];
    ASSERT_EQ(state.sequence, n);
    const Numbers numbers(n);
    ASSERT_EQ(state.q, std::vector<double>(numbers.q.begin(), numbers.q.end()));
  }
}

/// A process that writes `count` states, tells that a flush period is over, and is killed. Afterwards it waits, or goes
/// on writing so that it is killed in the midst of it.
void write_until_killed(const std::string& url, int count, bool goes_on) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t writer = fork();
  if (writer == 0) {
    auto publisher = open(url);
    for (int n = 0; n < count; ++n) (void)(*publisher)->publish(Numbers(n).snapshot());
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // some flush periods
    if (write(ready[1], "+", 1) != 1) std::abort();
    if (!goes_on) pause();
    for (int n = count;; ++n) (void)(*publisher)->publish(Numbers(n).snapshot());
  }
  char sign = 0;
  ASSERT_EQ(read(ready[0], &sign, 1), 1);
  if (goes_on) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  kill(writer, SIGKILL);
  int status = 0;
  ASSERT_EQ(waitpid(writer, &status, 0), writer);
  ASSERT_TRUE(WIFSIGNALED(status));
  ::close(ready[0]);
  ::close(ready[1]);
}

class KilledWriter : public testing::TestWithParam<bool> {};

TEST_P(KilledWriter, LeavesAReadableLog) {
  const TemporaryLog log;
  constexpr int count = 100;  // less than any buffer holds
  ASSERT_NO_FATAL_FAILURE(write_until_killed(log.url(), count, GetParam()));
  const auto states = log.read()->all<state_t>("KOPPEL_FOUR_BAR_STATE");
  if (GetParam()) {
    EXPECT_GT(states.size(), static_cast<std::size_t>(count));
  } else {
    EXPECT_EQ(states.size(), static_cast<std::size_t>(count)) << "what is older than the flush period is safe";
  }
  for (std::size_t n = 0; n < states.size(); ++n) ASSERT_EQ(states[n].sequence, static_cast<std::int64_t>(n));
}

INSTANTIATE_TEST_SUITE_P(Log, KilledWriter, testing::Bool(),
                         [](const auto& goes_on) { return goes_on.param ? "WhileWriting" : "WhileWaiting"; });

TEST(Log, GrowsByWholeEvents) {
  const TemporaryLog log;
  auto sink = LogSink::open(*read_provider_url(log.url()));
  ASSERT_TRUE(sink);
  const std::vector<std::uint8_t> message(777, 0x55);
  while (log.size() == 0) ASSERT_TRUE((*sink)->send("CHANNEL", message));
  // Sync word, number, time and two lengths go before channel and data.
  EXPECT_EQ(log.size() % (28 + 7 + message.size()), 0u);
  EXPECT_EQ(log.size() / (28 + 7 + message.size()), log.read()->messages().size());
}

TEST(Log, ReportsAFullDisk) {
  auto publisher = open("file:///dev/full?mode=w");
  ASSERT_TRUE(publisher) << render(publisher.error());
  // Far more than the buffers hold: it must neither hang nor go unnoticed.
  std::size_t refused = 0;
  for (int n = 0; n < 100'000 && refused == 0; ++n) {
    const auto result = (*publisher)->publish(Numbers(n).snapshot());
    if (result) continue;
    ++refused;
    EXPECT_EQ(result.error().code, Code::stream_failed);
  }
  EXPECT_EQ(refused, 1u);
  EXPECT_FALSE((*publisher)->event(0, Severity::note, "lost"));
  const auto statistics = (*publisher)->close();
  ASSERT_FALSE(statistics);
  EXPECT_EQ(statistics.error().code, Code::stream_failed);
}

TEST(Log, ReportsAFullDiskThatShowsOnlyAtTheEnd) {
  auto publisher = open("file:///dev/full?mode=w");
  ASSERT_TRUE(publisher);
  EXPECT_FALSE((*publisher)->close());
}

TEST(Log, RefusesFilesThatCannotBeWritten) {
  for (const char* path : {"/nowhere/at/all.lcm", "/tmp"}) {
    const auto publisher = open("file://" + std::string(path) + "?mode=w");
    ASSERT_FALSE(publisher) << path;
    EXPECT_EQ(publisher.error().code, Code::stream_failed);
    EXPECT_NE(publisher.error().message.find("cannot be written"), std::string::npos);
    EXPECT_FALSE(publisher.error().advice.empty());
  }
}

TEST(Log, IsNotEmptiedByABadOption) {
  const TemporaryLog log;
  ASSERT_TRUE((*open(log.url()))->close());
  StreamOptions options;
  options.url = log.url();
  options.name = "no such name!";
  ASSERT_FALSE(Publisher::open(example_model(), options, silent_logger()));
  EXPECT_EQ(log.read()->messages().size(), 1u);
}

}  // namespace
}  // namespace koppel::test
