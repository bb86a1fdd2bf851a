#include "stream/network_sink.hpp"

#include <utility>

#include <lcm/lcm.h>

namespace koppel {

Result<std::unique_ptr<NetworkSink>> NetworkSink::open(const ProviderUrl& url) {
  Handle lcm(lcm_create(url.text.c_str()), lcm_destroy);
  if (!lcm) {
    Error error;
    error.code = Code::stream_url;
    error.element = "stream " + url.text;
    error.message = "LCM cannot open it";
    return tl::make_unexpected(std::move(error));
  }
  return std::unique_ptr<NetworkSink>(new NetworkSink(std::move(lcm)));
}

bool NetworkSink::send(const std::string& channel, std::span<const std::uint8_t> message) {
  return lcm_publish(lcm_.get(), channel.c_str(), message.data(), static_cast<unsigned>(message.size())) == 0;
}

}  // namespace koppel
