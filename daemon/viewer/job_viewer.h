// The one viewer of outputs: `weir view` as a process of its own, started when somebody asks for it, ended when nobody
// is connected for a while, when it takes more memory than it may, and with the service. It is reached through the
// service alone, which passes bytes on; its token is known to nobody else. One thread, that of the io_context.
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
  std::chrono::milliseconds start{60'000};  ///< until it answers
  std::chrono::milliseconds open{20'000};   ///< from its answer, for the page of who asked for it to come
  std::chrono::milliseconds idle{300'000};  ///< while nobody looks
  std::chrono::milliseconds look{1'000};    ///< between two looks at its memory
  std::chrono::milliseconds page{30'000};   ///< for one file of its page to be taken
};

class JobViewer {
 public:
  enum class Opened { made, off, taken };

  /// `log` must outlive the object. `program` is the `weir` that views. Nothing is started before configure().
  JobViewer(boost::asio::io_context& io, const EventLog& log, std::string program, JobViewerTimes times = {});
  ~JobViewer() { end(); }
  JobViewer(const JobViewer&) = delete;
  JobViewer& operator=(const JobViewer&) = delete;

  /// Takes memory, threads and priority from now on; a viewer that runs with others ends.
  void configure(const ServiceConfig& service);
  /// Has a viewer of the series of `file`, a NanoVDB file: the one that runs, where it is of that series, else a new
  /// one in its place. That one is left to those who look at it, or have asked for it and are on their way, unless
  /// `force`. A failure to start is in view().
  Opened open(const std::string& file, bool force);
  ViewerView view() const;
  /// Answers a connection by the viewer, which is ready.
  void relay(Relay::Client client, const UpgradeRequest& request);
  /// Ends it and all connections to it; none is started from here on.
  void end();

 private:
  struct Connection {
    std::shared_ptr<Relay> relay;
    bool looks = false;  // a WebSocket: somebody has the page open
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
  std::chrono::steady_clock::time_point awaited_until_;  // a page of who asked for it; over when it has come
  std::string token_;
  boost::asio::ip::tcp::endpoint address_;
  std::unique_ptr<WorkerProcess> worker_;
  std::vector<Connection> connections_;
  boost::asio::steady_timer wait_;  // for its start, or for the end of the idle time
  boost::asio::steady_timer look_;
};

}  // namespace weir
