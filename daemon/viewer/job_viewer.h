// The only viewer of outputs: `weir view` in a process of its own. It starts when somebody asks for it. It ends when
// nobody is connected for a while, when it takes more memory than it may, and with the service. Clients reach it only
// through the service, which passes bytes on; nobody else knows its token. One thread: the io_context's.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/http/control.h"
#include "daemon/http/relay.h"
#include "daemon/http/socket_handler.h"
#include "daemon/jobs/worker_process.h"
#include "daemon/log/event_log.h"

namespace weir {

struct JobViewerTimes {
  std::chrono::milliseconds start{60'000};  ///< limit from the start to the first answer
  std::chrono::milliseconds open{20'000};   ///< limit from the answer until the page of the requester connects
  std::chrono::milliseconds idle{300'000};  ///< without a viewing page, until the viewer ends
  std::chrono::milliseconds look{1'000};    ///< between two checks of its memory
  std::chrono::milliseconds page{30'000};   ///< limit for sending one file of its page
};

class JobViewer {
 public:
  enum class Opened { made, off, taken };

  /// `log` must outlive the object. `program` is the path of the `weir` that runs the viewer. Nothing is started
  /// before configure().
  JobViewer(boost::asio::io_context& io, const EventLog& log, std::string program, JobViewerTimes times = {});
  ~JobViewer() { end(); }
  JobViewer(const JobViewer&) = delete;
  JobViewer& operator=(const JobViewer&) = delete;

  /// Uses the memory, threads and priority of `service` from now on. A viewer that runs with other settings ends.
  void configure(const ServiceConfig& service);
  /// Opens a viewer of the series of `file`, a NanoVDB file. A running viewer of this series is kept; a viewer of
  /// another series is replaced. But unless `force`, it is not replaced while somebody looks at it, or has asked for
  /// it and is about to connect. view() reports a failure to start.
  Opened open(const std::string& file, bool force);
  ViewerView view() const;
  /// Lets the viewer, which must be ready, answer the connection.
  void relay(Relay::Client client, const UpgradeRequest& request);
  /// Ends the viewer and all connections to it; no viewer starts afterwards.
  void end();

 private:
  struct Connection {
    std::shared_ptr<Relay> relay;
    bool looks = false;  // a WebSocket, which means that somebody has the page open
  };

  void start(const std::string& file);
  void heard(std::string_view line);
  void ended(const WorkerEnd& end);
  void fail(const std::string& reason);
  void stop();
  void await_page();
  void end_when_idle();
  void look_at_memory();
  void remove(const Relay& relay);
  void make_room_for_a_file();
  std::size_t sockets() const;
  bool looked_at() const;
  bool taken() const;

  boost::asio::io_context& io_;
  const EventLog& log_;
  const std::string program_;
  const JobViewerTimes times_;
  ServiceConfig service_;
  bool over_ = false;
  ViewerState state_ = ViewerState::none;
  std::string reason_;
  std::string file_;
  std::chrono::steady_clock::time_point
      awaited_until_;  // until when the requester's page is awaited; in the past when it has connected
  std::string token_;
  boost::asio::ip::tcp::endpoint address_;
  std::unique_ptr<WorkerProcess> worker_;
  std::vector<Connection> connections_;
  boost::asio::steady_timer wait_;  // for the start limit, or for the idle limit
  boost::asio::steady_timer look_;
};

}  // namespace weir
