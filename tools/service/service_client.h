// The other end of the control server: what `weir jobs`, `weir status`,
// `weir retry`, `weir cancel`, `weir pause` and `weir resume` ask a running `weir watch`. One request, one connection.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/config/listen_address.h"

namespace CLI {
class App;
}

namespace weir {

/// The service's address and token, as options.
struct ServiceOptions {
  std::string address;     ///< HOST:PORT or unix:PATH
  std::string config;      ///< CONFIG.toml, which says both
  std::string token_file;  ///< else the environment's WEIR_TOKEN
};

/// Adds --address, --config and --token-file.
void add_service_options(CLI::App& command, ServiceOptions& options);

class ServiceClient {
 public:
  using Json = nlohmann::ordered_json;

  ServiceClient(ListenAddress address, std::string token)
      : address_(std::move(address)), control_(address_), token_(std::move(token)) {}
  /// As the options say: 127.0.0.1:8470 where they say nothing. Of a configuration with a control socket, what changes
  /// something is asked there, and all else at `listen`. Throws Error(usage) for an address that is none,
  /// Error(input) for a file that cannot be read, or is no configuration.
  explicit ServiceClient(const ServiceOptions& options);

  /// The JSON the service answers. Throws Error(io) where it does not answer, or not as weir does; Error(usage) with
  /// its own message where it refuses; Error(interrupted) where interrupt_flag() was set before the answer.
  Json get(const std::string& target) const { return ask("GET", target); }
  Json post(const std::string& target) const { return ask("POST", target); }

  /// use(answer), where `answer` has the members that weir's would have; else throws Error(io).
  template <typename Use>
  auto read(const Json& answer, Use use) const {
    try {
      return use(answer);
    } catch (const Json::exception&) {
      refuse_foreign();
    }
  }

 private:
  Json ask(const std::string& method, const std::string& target) const;
  [[noreturn]] void refuse_foreign() const;

  ListenAddress address_;
  ListenAddress control_;  ///< for post(); the same where there is no other
  std::string token_;
};

}  // namespace weir
