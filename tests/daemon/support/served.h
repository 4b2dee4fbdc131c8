// A control server on a free loopback port, run by a thread of its own.
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "daemon/http/control_server.h"
#include "format/base/text.h"

namespace weir {

class Served {
 public:
  explicit Served(Control& control, const std::string& token = "", const HttpLimits& limits = {},
                  const std::string& control_socket = "")
      : server_(std::make_unique<ControlServer>(io_, settings(token, limits, control_socket), control, no_viewer)),
        port_(server_->port()),
        thread_([this] { io_.run(); }) {}
  ~Served() {
    boost::asio::post(io_, [this] {
      server_.reset();
      work_.reset();
    });
    thread_.join();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  std::uint16_t port() const { return port_; }
  std::string address() const { return cat("127.0.0.1:", port_); }

  /// Runs `work()` on the server's thread, which may use the control. Returns its result.
  template <typename Work>
  auto run(Work work) {
    std::packaged_task<decltype(work())()> task(std::move(work));
    auto result = task.get_future();
    boost::asio::post(io_, std::move(task));
    return result.get();
  }
  /// Stops listening and closes all connections.
  void close() {
    run([this] { server_.reset(); });
  }
  /// Like close(), but returns at once: the server's thread closes after its present work. May be called on that
  /// thread.
  void close_soon() {
    boost::asio::post(io_, [this] { server_.reset(); });
  }

 private:
  static void no_viewer(boost::asio::generic::stream_protocol::socket, const UpgradeRequest&) {}
  static ControlServerSettings settings(const std::string& token, const HttpLimits& limits,
                                        const std::string& control_socket) {
    ControlServerSettings result;
    result.address = {"127.0.0.1", 0};
    result.token = token;
    result.limits = limits;
    result.control_socket = control_socket;
    return result;
  }

  boost::asio::io_context io_;
  // Keeps io_ running while the server is closed.
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
  std::unique_ptr<ControlServer> server_;
  std::uint16_t port_;
  std::thread thread_;
};

}  // namespace weir
