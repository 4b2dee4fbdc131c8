#include "daemon/config/listen_address.h"

#include <boost/asio/ip/address.hpp>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::string_view kUnix = "unix:";

[[noreturn]] void refuse(std::string_view text, std::string_view option, const std::string& reason) {
  throw Error(ErrorKind::usage, cat(option, option.empty() ? "" : ": ", text, reason));
}

[[noreturn]] void refuse(std::string_view text, std::string_view option) {
  refuse(cat('"', text, '"'), option, " is no address; write HOST:PORT, as 127.0.0.1:8470 or [::1]:8470");
}

}  // namespace

std::string ListenAddress::text() const {
  if (is_unix()) return cat(kUnix, path);
  return host.find(':') == std::string::npos ? cat(host, ':', port) : cat('[', host, "]:", port);
}

ListenAddress parse_listen_address(std::string_view text, std::string_view option) {
  if (text.starts_with(kUnix)) {
    if (text.size() == kUnix.size()) refuse(text, option);
    if (text.size() > kUnix.size() + kLongestSocketPath) {
      refuse(text, option, cat(": a socket's path has ", kLongestSocketPath, " bytes at most"));
    }
    return {"", 0, std::string(text.substr(kUnix.size()))};
  }
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) refuse(text, option);
  std::string_view host = text.substr(0, colon);
  const bool bracketed = host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  // Without brackets, the last group of an IPv6 address would be taken for the port.
  if (host.empty() || bracketed != (host.find(':') != std::string_view::npos)) refuse(text, option);
  if (host.find_first_of(" /@[]") != std::string_view::npos) refuse(text, option);
  const auto port = parse_int(text.substr(colon + 1));
  if (!port || *port < 0 || *port > 65535) refuse(text, option);
  return {std::string(host), static_cast<std::uint16_t>(*port)};
}

bool is_loopback(std::string_view host) {
  if (host == "localhost") return true;
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(std::string(host), error);
  return !error && address.is_loopback();
}

}  // namespace weir
