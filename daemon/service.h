// The daemon: everything that `weir watch CONFIG.toml` does, from its first log line to its last. Connects the parts
// and handles signals:
//   SIGTERM, SIGINT  starts no more jobs; ends when the running jobs are done or the grace time is over. A second
//                    signal ends the daemon at once
//   SIGHUP           reads the configuration again and opens the log file anew. A configuration that a start would
//                    refuse changes nothing
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/http/control_server.h"
#include "daemon/jobs/job_history.h"
#include "daemon/jobs/job_runner.h"
#include "daemon/log/event_log.h"
#include "daemon/log/notify.h"
#include "daemon/service_control.h"
#include "daemon/store/disk_turns.h"
#include "daemon/store/job_store.h"
#include "daemon/viewer/job_viewer.h"
#include "daemon/watched_tree.h"

namespace weir {

class Service {
 public:
  using Load = std::function<DaemonConfig()>;  ///< reads the configuration; throws Error as load_config does

  /// Cleans the output directories, opens the state file and listens. `program` is the path of the `weir` that
  /// converts. Throws Error if the service cannot run.
  Service(Load load, std::string program, std::string version);

  /// Watches and converts until a signal ends the service.
  void run();

 private:
  void clean(const std::vector<WatchConfig>& watches, std::chrono::milliseconds patience) const;
  std::vector<WatchConfig> watches_to_clean(const DaemonConfig& before) const;
  void watch_trees();
  void write_port_file() const;
  void await_signal();
  void reload();
  std::optional<DaemonConfig> load_again();
  void reopen_log();
  void apply(DaemonConfig config);
  void shut_down();
  void feed_watchdog();
  void checkpoint_when_due();
  void checkpoint();

  boost::asio::io_context io_;
  DiskTurns turns_{io_};
  Load load_;
  DaemonConfig config_;
  EventLog log_;
  ServiceNotifier notifier_;
  JobStore store_;
  ServiceState state_;
  JobRunner runner_;
  WatchedTrees trees_;
  JobViewer viewer_;
  ServiceControl control_;
  JobHistory history_;
  ControlServer server_;
  boost::asio::signal_set signals_;
  boost::asio::steady_timer watchdog_timer_;
  boost::asio::steady_timer checkpoint_timer_;
};

}  // namespace weir
