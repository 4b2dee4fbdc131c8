// The client of the control server, with which `weir jobs`, `weir status`, `weir retry`, `weir cancel`, `weir pause`
// and `weir resume` talk to a running `weir watch`. Each request uses its own connection.
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
  std::string config;      ///< CONFIG.toml, which holds address and token
  std::string token_file;  ///< if empty, the environment's WEIR_TOKEN is used
};

/// Adds --address, --config and --token-file.
void add_service_options(CLI::App& command, ServiceOptions& options);

class ServiceClient {
 public:
  using Json = nlohmann::ordered_json;

  ServiceClient(ListenAddress address, std::string token)
      : address_(std::move(address)), control_(address_), token_(std::move(token)) {}
  /// Uses the address and token of the options; the default address is 127.0.0.1:8470. If the configuration has a
  /// control socket, post() uses it and get() uses `listen`. Throws Error(usage) for an invalid address, Error(input)
  /// for a file that cannot be read or is no configuration.
  explicit ServiceClient(const ServiceOptions& options);

  /// Return the service's JSON answer. Throw Error(io) if the service does not answer, or not as weir does;
  /// Error(usage) with the service's message if it refuses; Error(interrupted) if interrupt_flag() is set before the
  /// answer.
  Json get(const std::string& target) const { return ask("GET", target); }
  Json post(const std::string& target) const { return ask("POST", target); }

  /// Returns use(answer). Throws Error(io) if `answer` lacks a member that weir's answers have.
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
  ListenAddress control_;  ///< for post(); equal to `address_` without a control socket
  std::string token_;
};

}  // namespace weir
