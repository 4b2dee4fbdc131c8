#include "daemon/service.h"

#include <algorithm>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <utility>

#include "daemon/config/check_access.h"
#include "daemon/config/watch_conflicts.h"
#include "daemon/jobs/output_cleaning.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/mount_table.h"

namespace weir {
namespace {

using std::chrono::milliseconds;

/// How long the start waits for output locks: the child processes of a killed daemon die a moment after it.
constexpr milliseconds kDyingWriters{10'000};
/// Time between two checks of the length of the state file's journal.
constexpr milliseconds kCheckpoint{1000};

std::uint64_t monotonic_usec() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000 + static_cast<std::uint64_t>(now.tv_nsec) / 1000;
}

// Returns whether `a` and `b` differ in a setting that a running service cannot change.
bool needs_restart(const ServiceConfig& a, const ServiceConfig& b) {
  return a.state != b.state || a.listen.host != b.listen.host || a.listen.port != b.listen.port ||
         a.control_socket != b.control_socket || a.port_file != b.port_file || a.token != b.token;
}

ControlServerSettings server_settings(const ServiceConfig& service) {
  ControlServerSettings settings;
  settings.address = service.listen;
  settings.token = service.token;
  settings.control_socket = service.control_socket;
  return settings;
}

}  // namespace

Service::Service(Load load, std::string program, std::string version)
    : load_(std::move(load)),
      config_(load_()),
      log_(config_.service),
      notifier_(ServiceNotifier::from_environment()),
      store_(config_.service.state),
      state_{.version = std::move(version), .config = config_.path, .jobs = config_.service.jobs},
      runner_(io_, store_, log_, program,
              [this](const Job& job) {
                for (const auto& tree : trees_) {
                  if (tree->config().label == job.watch) tree->look_again(job.source);
                }
              }),
      viewer_(io_, log_, std::move(program)),
      control_(io_, turns_, store_, runner_, trees_, viewer_, log_, state_),
      history_(io_, turns_, store_, log_),
      server_(
          io_, server_settings(config_.service), control_,
          [this](Relay::Client client, const UpgradeRequest& request) { viewer_.relay(std::move(client), request); }),
      signals_(io_, SIGTERM, SIGINT, SIGHUP),
      watchdog_timer_(io_),
      checkpoint_timer_(io_) {
  log_.info("begin", {{"version", state_.version}, {"config", config_.path}, {"state", config_.service.state}});
  if (!store_.notice().empty()) log_.warn("state-file", {{"notice", store_.notice()}});
  clean(config_.watches, kDyingWriters);
  write_port_file();
}

// Returns the watches whose outputs must be cleaned. Outputs of the configuration `before` were cleaned when they
// were added, if they were mounted. An output with a running job is left out, because its files are no leftovers.
std::vector<WatchConfig> Service::watches_to_clean(const DaemonConfig& before) const {
  std::vector<WatchConfig> watches;
  for (const WatchConfig& watch : config_.watches) {
    const auto has_its_output = [&](const WatchConfig& other) {
      return other.output == watch.output && other.directory == watch.directory && other.recursive == watch.recursive &&
             other.output_mount == watch.output_mount;
    };
    const auto writes_there = [&](const auto& running) {
      return is_within(std::filesystem::path(running.second.work->task().output).parent_path().string(), watch.output);
    };
    if (std::ranges::none_of(before.watches, has_its_output) && std::ranges::none_of(runner_.running(), writes_there)) {
      watches.push_back(watch);
    }
  }
  return watches;
}

void Service::clean(const std::vector<WatchConfig>& watches, milliseconds patience) const {
  for (const WatchConfig& watch : watches) {
    if (!is_mounted(watch.output_mount)) continue;
    const CleaningReport report = clean_outputs(watch.output, watch.directory, watch.recursive, patience);
    for (const std::string& path : report.removed) log_.info("cleaned", {{"removed", path}});
    for (const std::string& line : report.left) log_.warn("not-cleaned", {{"reason", line}});
  }
}

// Writes the port to a temporary file and renames it, so that a reader sees the number or nothing.
void Service::write_port_file() const {
  const std::string& path = config_.service.port_file;
  if (path.empty()) return;
  const std::string beside = path + ".new";
  std::ofstream file(beside);
  file << server_.port() << '\n';
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(beside, path, error);
  if (!file || error) {
    std::filesystem::remove(beside, error);
    throw Error(ErrorKind::io, cat(path, ": the port cannot be written there; check the directory"));
  }
}

void Service::watch_trees() {
  WatchedTrees before = std::move(trees_);
  trees_.clear();
  for (const WatchConfig& watch : config_.watches) {
    const auto same = std::find_if(before.begin(), before.end(),
                                   [&](const auto& tree) { return tree != nullptr && tree->config() == watch; });
    if (same != before.end()) {
      trees_.push_back(std::move(*same));
      trees_.back()->reloaded();
      continue;
    }
    trees_.push_back(std::make_unique<WatchedTree>(
        io_, turns_, watch, store_, log_,
        WatchedTree::Reports{[this] { runner_.wake(); }, [this](std::int64_t id) { runner_.abandon(id); }}));
  }
}

void Service::run() {
  try {
    store_.retry_failed_io();
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error& error) {  // for example, the state file's disk is full; all parts wait for it from here on
    log_.error("state-file-fault", {{"reason", error.what()}});
  }
  runner_.configure(config_);
  viewer_.configure(config_.service);
  runner_.resume_thumbnails();
  watch_trees();
  history_.keep(config_.service.history_days, config_.watches);
  await_signal();
  feed_watchdog();
  checkpoint_when_due();
  const ListenAddress& listen = config_.service.listen;
  log_.info("ready", {{"listen", listen.host}, {"port", server_.port()}, {"watches", trees_.size()}});
  if (const std::string& path = config_.service.control_socket; !path.empty()) log_.info("control", {{"socket", path}});
  notifier_.send(cat("READY=1\nSTATUS=", trees_.size(), " directories watched, port ", server_.port()));
  runner_.wake();
  try {
    io_.run();
  } catch (const CorruptDatabase& damage) {  // nothing is known for certain any more; running jobs end with the process
    log_.error("end", {{"reason", damage.what()}});
    throw Error(damage.kind(), compose(damage.message(), "; start again, then it is moved aside and rebuilt"));
  }
  log_.info("end", {});
}

void Service::await_signal() {
  signals_.async_wait([this](boost::system::error_code error, int signal) {
    if (error) return;
    if (signal == SIGHUP) {
      reload();
    } else {
      shut_down();
    }
    await_signal();
  });
}

void Service::reload() {
  notifier_.send(cat("RELOADING=1\nMONOTONIC_USEC=", monotonic_usec()));
  if (std::optional<DaemonConfig> config = load_again()) apply(*std::move(config));
  notifier_.send("READY=1");
}

// Returns the new configuration; none if it is refused. In this case the log continues under its configured name, in
// the present file if it cannot be opened anew.
std::optional<DaemonConfig> Service::load_again() {
  try {
    DaemonConfig config = load_();
    check_access(config, true);
    log_.reopen(config.service);
    return config;
  } catch (const Error& error) {
    ++state_.rejected_reloads;
    reopen_log();
    log_.error("reload-rejected", {{"reason", error.what()}, {"notice", "the configuration before stays"}});
    return std::nullopt;
  }
}

void Service::reopen_log() {
  try {
    log_.reopen(config_.service);
  } catch (const Error& error) {  // the open log file stays in use
    log_.error("reload-rejected", {{"reason", error.what()}, {"notice", "the log goes on in the file it has"}});
  }
}

void Service::apply(DaemonConfig config) {
  if (needs_restart(config_.service, config.service)) {
    log_.warn("reload",
              {{"notice", "state, listen, control_socket, port_file and token stay as they were until a restart"}});
    const ServiceConfig& old = config_.service;
    config.service.state = old.state;
    config.service.listen = old.listen;
    config.service.control_socket = old.control_socket;
    config.service.port_file = old.port_file;
    config.service.token = old.token;
  }
  const DaemonConfig before = std::exchange(config_, std::move(config));
  state_.jobs = config_.service.jobs;
  ++state_.reloads;
  clean(watches_to_clean(before), milliseconds(0));
  runner_.configure(config_);
  viewer_.configure(config_.service);
  watch_trees();
  history_.keep(config_.service.history_days, config_.watches);
  runner_.wake();
  log_.info("reload", {{"config", config_.path}, {"watches", trees_.size()}});
}

void Service::shut_down() {
  if (state_.stopping) {
    log_.warn("stop", {{"how", "at once"}});
    runner_.kill();
    return;
  }
  state_.stopping = true;
  const double grace_s = config_.service.grace_s;
  log_.info("stop", {{"running", runner_.running().size()}, {"grace_s", grace_s}});
  notifier_.send("STOPPING=1");
  viewer_.end();
  runner_.shut_down(milliseconds(static_cast<std::int64_t>(grace_s * 1000)), [this] { io_.stop(); });
}

void Service::feed_watchdog() {
  const auto period = notifier_.watchdog();
  if (!period) return;
  notifier_.send("WATCHDOG=1");
  watchdog_timer_.expires_after(*period / 3);
  watchdog_timer_.async_wait([this](boost::system::error_code error) {
    if (!error) feed_watchdog();
  });
}

void Service::checkpoint_when_due() {
  if (store_.checkpoint_due()) turns_.take([this] { checkpoint(); });
  checkpoint_timer_.expires_after(kCheckpoint);
  checkpoint_timer_.async_wait([this](boost::system::error_code error) {
    if (!error) checkpoint_when_due();
  });
}

void Service::checkpoint() {
  try {
    store_.checkpoint();
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error&) {  // for example a full disk, which the next write reports
  }
}

}  // namespace weir
