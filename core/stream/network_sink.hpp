// Messages sent by LCM: udpm:// and memq://.
#pragma once

#include <memory>

#include "base/error.hpp"
#include "stream/sink.hpp"
#include "stream/url.hpp"

struct _lcm_t;

namespace koppel {

class NetworkSink : public Sink {
 public:
  /// stream_url: LCM refused the URL.
  static Result<std::unique_ptr<NetworkSink>> open(const ProviderUrl& url);
  /// Borrows an LCM instance, which must outlive the sink: what is sent by memq:// is only heard in the same instance.
  explicit NetworkSink(_lcm_t* borrowed) : lcm_(borrowed, [](_lcm_t*) {}) {}

  bool lossless() const override { return false; }
  bool send(const std::string& channel, std::span<const std::uint8_t> message) override;
  bool flush() override { return true; }

 private:
  using Handle = std::unique_ptr<_lcm_t, void (*)(_lcm_t*)>;
  explicit NetworkSink(Handle lcm) : lcm_(std::move(lcm)) {}

  Handle lcm_;
};

}  // namespace koppel
