#include "tools/service/service_client.h"

#include <CLI/CLI.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/config/load_config.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/refused_open.h"
#include "tools/command.h"

namespace weir {
namespace {

namespace http = boost::beast::http;
using boost::asio::generic::stream_protocol;
using boost::asio::ip::tcp;
using UnixEndpoint = boost::asio::local::stream_protocol::endpoint;
using boost::system::error_code;

constexpr std::chrono::seconds kPatience{30};                  // time limit for a whole answer
constexpr std::chrono::milliseconds kInterruptLook{100};       // how often a wait checks the interrupt flag
constexpr std::uint64_t kMaxAnswer = std::uint64_t{64} << 20;  // bytes; a full page of jobs is a few MiB

std::string first_word_of(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw refused_open(path, "open", errno);
  std::string word;
  file >> word;
  return word;
}

// Returns the host to connect to. A server that listens on all addresses is reached at this machine's loopback
// address.
std::string reachable(const std::string& host) {
  if (host == "0.0.0.0") return "127.0.0.1";
  return host == "::" ? "::1" : host;
}

ListenAddress address_of(const ServiceConfig& service) {
  ListenAddress address = service.listen;
  if (address.port == 0) {
    if (service.port_file.empty()) {
      throw Error(ErrorKind::usage, "the configuration listens on any free port and has no port_file; give --address");
    }
    const std::string word = first_word_of(service.port_file);
    const auto port = parse_int(word);
    if (!port || *port < 1 || *port > 65535) {
      throw Error(ErrorKind::input, cat(service.port_file, ": \"", word, "\" is no port; is weir watch running?"));
    }
    address.port = static_cast<std::uint16_t>(*port);
  }
  return address;
}

// One request and its answer over one connection, within kPatience.
class Exchange {
 public:
  Exchange(const ListenAddress& address, const http::request<http::empty_body>& request)
      : address_(address), request_(request), resolver_(io_), stream_(io_) {
    parser_.body_limit(kMaxAnswer);
  }

  http::response<http::string_body> run() {
    stream_.expires_after(kPatience);
    if (address_.is_unix()) {
      connect({UnixEndpoint(address_.path)});
    } else {
      resolve();
    }
    while (!io_.stopped()) {
      if (interrupt_flag())
        throw Error(ErrorKind::interrupted, cat(address_.text(), ": interrupted before it answered"));
      io_.run_for(kInterruptLook);
    }
    if (!failure_.empty()) throw Error(ErrorKind::io, cat(address_.text(), ": ", failure_));
    return parser_.release();
  }

 private:
  void resolve() {
    resolver_.async_resolve(reachable(address_.host), cat(address_.port),
                            [this](const error_code& error, const tcp::resolver::results_type& found) {
                              if (!ok("find", error)) return;
                              std::vector<stream_protocol::endpoint> endpoints;
                              for (const auto& one : found) endpoints.emplace_back(one.endpoint());
                              connect(endpoints);
                            });
  }
  void connect(const std::vector<stream_protocol::endpoint>& endpoints) {
    stream_.async_connect(endpoints, [this](const error_code& error, const stream_protocol::endpoint&) {
      if (ok("connect", error)) send();
    });
  }
  void send() {
    http::async_write(stream_, request_, [this](const error_code& error, std::size_t) {
      if (ok("send", error)) receive();
    });
  }
  void receive() {
    http::async_read(stream_, buffer_, parser_, [this](const error_code& error, std::size_t) { ok("receive", error); });
  }
  bool ok(const char* action, const error_code& error) {
    if (error == boost::beast::error::timeout) {
      failure_ = cat("no answer within ", kPatience.count(), " s");
    } else if (error) {
      failure_ = cat("cannot ", action, ": ", error.message(),
                     "; is weir watch running there? name its address with --address or --config");
    }
    return !error;
  }

  const ListenAddress& address_;
  const http::request<http::empty_body>& request_;
  boost::asio::io_context io_;
  tcp::resolver resolver_;
  boost::beast::basic_stream<stream_protocol> stream_;
  boost::beast::flat_buffer buffer_;
  http::response_parser<http::string_body> parser_;
  std::string failure_;
};

// Throws weir's own refusal as an error of the command.
[[noreturn]] void refuse(const std::string& where, unsigned status, const nlohmann::ordered_json& body,
                         bool gave_token) {
  const auto message = body.is_object() ? body.value("error", "") : std::string();
  if (message.empty()) throw Error(ErrorKind::io, cat(where, ": the answer is ", status, " and not weir's"));
  if (status == 401 && gave_token) {
    throw Error(ErrorKind::usage, cat(where,
                                      ": the service has another token than the one given; check --token-file, "
                                      "WEIR_TOKEN or the token of --config"));
  }
  if (status == 401) {
    throw Error(ErrorKind::usage, cat(where, ": the service wants its token; give it with --token-file or WEIR_TOKEN"));
  }
  throw Error(status < 500 ? ErrorKind::usage : ErrorKind::io, cat(where, ": ", message));
}

}  // namespace

void add_service_options(CLI::App& command, ServiceOptions& options) {
  auto* address = command.add_option("--address", options.address, "of the service")
                      ->type_name("HOST:PORT|unix:PATH")
                      ->default_str("127.0.0.1:8470");
  command.add_option("--config", options.config, "of the service, for its address and token")
      ->type_name("CONFIG.toml")
      ->excludes(address);
  command.add_option("--token-file", options.token_file, "with the service's token; else WEIR_TOKEN is it")
      ->type_name("FILE");
}

ServiceClient::ServiceClient(const ServiceOptions& options) : address_{"127.0.0.1", 8470} {
  if (!options.address.empty()) address_ = parse_listen_address(options.address, "--address");
  if (!options.config.empty()) {
    const ServiceConfig service = load_config(options.config).service;
    token_ = service.token;
    if (!service.control_socket.empty()) control_ = {"", 0, service.control_socket};
    const bool has_no_port = service.listen.port == 0 && service.port_file.empty();
    address_ = has_no_port && control_.is_unix() ? control_ : address_of(service);
  }
  if (!control_.is_unix()) control_ = address_;
  if (!options.token_file.empty()) {
    token_ = first_word_of(options.token_file);
    if (token_.empty())
      throw Error(ErrorKind::usage, cat(options.token_file, ": holds no token; name a file with one"));
  } else if (const char* token = std::getenv("WEIR_TOKEN"); token != nullptr && token_.empty()) {
    token_ = token;
  }
}

ServiceClient::Json ServiceClient::ask(const std::string& method, const std::string& target) const {
  const ListenAddress& address = method == "GET" ? address_ : control_;
  http::request<http::empty_body> request(http::string_to_verb(method), target, 11);
  request.set(http::field::host, address.is_unix() ? "localhost" : address.text());
  request.set(http::field::connection, "close");
  request.set("X-Weir", "command");
  if (!token_.empty() && !address.is_unix()) request.set(http::field::authorization, "Bearer " + token_);
  request.prepare_payload();
  const auto response = Exchange(address, request).run();
  Json body = Json::parse(response.body(), nullptr, false);
  if (response.result_int() >= 400) refuse(address.text(), response.result_int(), body, !token_.empty());
  if (body.is_discarded()) refuse_foreign();
  return body;
}

void ServiceClient::refuse_foreign() const {
  throw Error(ErrorKind::io, cat(address_.text(), ": the answer is not weir's"));
}

}  // namespace weir
