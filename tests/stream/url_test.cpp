#include "stream/url.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "example.hpp"

namespace koppel::test {
namespace {

/// Sets LCM_DEFAULT_URL for a scope.
class DefaultUrl {
 public:
  explicit DefaultUrl(const char* url) { setenv("LCM_DEFAULT_URL", url, 1); }
  ~DefaultUrl() { unsetenv("LCM_DEFAULT_URL"); }
};

TEST(ProviderUrl, AcceptsLogsAndMemory) {
  const auto log = read_provider_url("file:///tmp/a b/run.lcm?mode=w");
  ASSERT_TRUE(log);
  EXPECT_EQ(log->kind, ProviderUrl::Kind::log);
  EXPECT_EQ(log->path, "/tmp/a b/run.lcm");
  EXPECT_EQ(read_provider_url("file://run.lcm?mode=w")->path, "run.lcm");
  EXPECT_EQ(read_provider_url("memq://")->kind, ProviderUrl::Kind::memory);
}

TEST(ProviderUrl, TakesTheEnvironmentsWhenThereIsNone) {
  const DefaultUrl environment("memq://");
  EXPECT_EQ(read_provider_url("")->kind, ProviderUrl::Kind::memory);
}

// Multicast may be missing on the machine that runs this; what is wrong in the text itself is found all the same.
TEST(ProviderUrl, RefusesBadOnesWithAdviceAndWithoutPrinting) {
  const char* const bad[] = {
      "run.lcm",
      "file",
      "file://?mode=w",
      "file:///tmp/run.lcm",
      "file:///tmp/run.lcm?mode=r",
      "file:///tmp/run.lcm?mode=a",
      "file:///tmp/run.lcm?mode=w&speed=2",
      "file:///tmp/run.lcm?mode=w?mode=w",
      "memq://x",
      "memq://?a=b",
      "http://localhost",
      "tcpq://127.0.0.1:7700",
      "udpm://nowhere:7667",
      "udpm://192.168.1.1:7667",
      "udpm://239.255.76.67",
      "udpm://239.255.76.67:",
      "udpm://239.255.76.67:0",
      "udpm://239.255.76.67:70000",
      "udpm://239.255.76.67:76x",
      "udpm://239.255.76.67:7667?ttl=",
      "udpm://239.255.76.67:7667?ttl=-1",
      "udpm://239.255.76.67:7667?ttl=256",
      "udpm://239.255.76.67:7667?tll=0",
      "udpm://239.255.76.67:7667?recv_buf_size=many",
      "://",
  };
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  for (const char* text : bad) {
    StreamOptions options;
    options.url = text;
    const auto publisher = Publisher::open(example_model(), options, silent_logger());
    ASSERT_FALSE(publisher) << text;
    EXPECT_EQ(publisher.error().code, Code::stream_url) << text;
    EXPECT_NE(publisher.error().element.find(text), std::string::npos) << text;
    EXPECT_FALSE(publisher.error().message.empty()) << text;
    EXPECT_FALSE(publisher.error().advice.empty()) << text;
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(ProviderUrl, ReportsMissingMulticastWithoutPrinting) {
  testing::internal::CaptureStderr();
  const auto url = read_provider_url("udpm://239.255.76.67:7667?ttl=0");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  if (url) {
    EXPECT_EQ(url->kind, ProviderUrl::Kind::multicast);
  } else {
    EXPECT_NE(url.error().advice.find("ip route add"), std::string::npos);
  }
}

}  // namespace
}  // namespace koppel::test
