// Checks again and again whether the metadata of known Zarr hierarchies have changed. Nothing watches the directories
// of their groups and arrays, because there may be as many directories as chunks.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/store/job.h"

namespace weir {

/// One thread, that of the io_context.
class StorePoll {
 public:
  /// `changed` is called from a handler with the head of each hierarchy that differs from its state at the last call
  /// of seen(). It is called again in each round until seen() is called anew. A round begins
  /// WatchConfig::poll_interval_s after the end of the round before.
  StorePoll(boost::asio::io_context& io, const WatchConfig& watch,
            std::function<void(const std::string& head)> changed);

  /// Records what identify_source() returned for the hierarchy with this head.
  void seen(const std::string& head, const FileIdentity& identity);
  void forget(const std::string& head) { known_.erase(head); }

 private:
  void wait(std::chrono::duration<double> delay);
  void look();

  std::vector<std::string> convert_options_;
  std::chrono::duration<double> interval_;
  std::function<void(const std::string& head)> changed_;
  std::map<std::string, FileIdentity> known_;
  std::string last_;  ///< the last head of this round; empty: the round has not begun
  bool waiting_ = false;
  boost::asio::steady_timer timer_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a queued handler may outlive the object
};

}  // namespace weir
