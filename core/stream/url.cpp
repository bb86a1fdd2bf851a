#include "stream/url.hpp"

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace koppel {
namespace {

constexpr const char* default_url = "udpm://239.255.76.67:7667?ttl=0";
constexpr const char* known_forms =
    "write udpm://239.255.76.67:7667?ttl=0 for the network or file:///tmp/run.lcm?mode=w for a log";

using Options = std::vector<std::pair<std::string_view, std::string_view>>;

tl::unexpected<Error> refused(const std::string& url, const std::string& why, const std::string& advice) {
  Error error;
  error.code = Code::stream_url;
  error.element = "stream " + url;
  error.message = why;
  error.advice = advice;
  return tl::make_unexpected(std::move(error));
}

std::string quoted(std::string_view text) {
  std::string result(1, '`');
  result.append(text).push_back('`');
  return result;
}

std::pair<std::string_view, std::string_view> split(std::string_view text, std::string_view separator) {
  const auto at = text.find(separator);
  if (at == text.npos) return {text, {}};
  return {text.substr(0, at), text.substr(at + separator.size())};
}

Options read_options(std::string_view text) {
  Options options;
  while (!text.empty()) {
    const auto [option, rest] = split(text, "&");
    if (!option.empty()) options.push_back(split(option, "="));
    text = rest;
  }
  return options;
}

std::optional<int> whole_number(std::string_view text, int most) {
  int value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || value < 0 || value > most) return std::nullopt;
  return value;
}

/// The system's reason why nothing can be sent to the group; nothing if it can. The same two steps that LCM takes.
std::optional<std::string> unreachable(const sockaddr_in& group) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return std::strerror(errno);
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  const bool fine = ::connect(socket, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0 &&
                    ::setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
  const int reason = errno;
  ::close(socket);
  if (fine) return std::nullopt;
  return std::strerror(reason);
}

Result<ProviderUrl> multicast(const std::string& url, std::string_view target, const Options& options) {
  for (const auto& [key, value] : options) {
    if (key != "ttl" && key != "recv_buf_size")
      return refused(url, std::string("udpm does not know the option ") + quoted(key),
                     "its options are ttl and recv_buf_size");
    if (!whole_number(value, key == "ttl" ? 255 : 1 << 30))
      return refused(url, quoted(key) + " takes a whole number, not " + quoted(value),
                     "ttl=0 keeps the packets on this machine, ttl=1 in the local network");
  }
  if (target.empty()) target = "239.255.76.67:7667";
  const auto [address, port] = split(target, ":");
  sockaddr_in group{};
  group.sin_family = AF_INET;
  if (::inet_pton(AF_INET, std::string(address).c_str(), &group.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(group.sin_addr.s_addr)))
    return refused(url, quoted(address) + " is not an IPv4 multicast address",
                   "they go from 224.0.0.0 to 239.255.255.255; " + std::string(known_forms));
  const auto number = whole_number(port, 65535);
  if (!number || *number == 0)
    return refused(url, quoted(port) + " is not a port", "ports go from 1 to 65535; LCM's usual one is 7667");
  group.sin_port = htons(static_cast<std::uint16_t>(*number));
  if (const auto reason = unreachable(group))
    return refused(url, "this machine cannot send multicast now: " + *reason,
                   "without a network, allow it on the loopback interface: ip link set lo multicast on; "
                   "ip route add 224.0.0.0/4 dev lo");
  return ProviderUrl{ProviderUrl::Kind::multicast, url, {}};
}

Result<ProviderUrl> log(const std::string& url, std::string_view target, const Options& options) {
  if (target.empty()) return refused(url, "the file's name is missing", known_forms);
  bool writes = false;
  for (const auto& [key, value] : options) {
    if (key != "mode")
      return refused(url, std::string("a log that is written does not know the option ") + quoted(key),
                     "its only option is mode=w");
    if (value != "w") return refused(url, "a stream can only write a log anew", "write ?mode=w behind the file's name");
    writes = true;
  }
  if (!writes)
    return refused(url, "without ?mode=w, LCM would read the log", "write file://" + std::string(target) + "?mode=w");
  return ProviderUrl{ProviderUrl::Kind::log, url, std::string(target)};
}

}  // namespace

Result<ProviderUrl> read_provider_url(std::string text) {
  if (text.empty()) {
    const char* environment = std::getenv("LCM_DEFAULT_URL");
    text = environment != nullptr && *environment != '\0' ? environment : default_url;
  }
  if (text.find("://") == text.npos) return refused(text, "it is not a URL of an LCM provider", known_forms);
  const auto [provider, rest] = split(text, "://");
  const auto [target, query] = split(rest, "?");
  if (query.find('?') != query.npos) return refused(text, "it has more than one question mark", known_forms);
  const Options options = read_options(query);
  if (provider == "udpm") return multicast(text, target, options);
  if (provider == "file") return log(text, target, options);
  if (provider == "memq" && rest.empty()) return ProviderUrl{ProviderUrl::Kind::memory, text, {}};
  if (provider == "memq") return refused(text, "memq takes neither a target nor options", "write memq://");
  return refused(text, "the provider " + quoted(provider) + " is not supported", known_forms);
}

}  // namespace koppel
