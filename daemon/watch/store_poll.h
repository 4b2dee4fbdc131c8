// Looks again and again whether the metadata of known Zarr hierarchies have changed: those of their groups and arrays
// lie in directories that nothing watches, as there may be as many directories as chunks.
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
  /// `changed` is called, from a handler, with the head of each hierarchy that is not what it was when seen() was
  /// called; again in each round, WatchConfig::poll_interval_s after the end of the one before, until it is called
  /// anew.
  StorePoll(boost::asio::io_context& io, const WatchConfig& watch,
            std::function<void(const std::string& head)> changed);

  /// What identify_source() says of the hierarchy with this head.
  void seen(const std::string& head, const FileIdentity& identity);
  void forget(const std::string& head) { known_.erase(head); }

 private:
  void wait(std::chrono::duration<double> delay);
  void look();

  std::vector<std::string> convert_options_;
  std::chrono::duration<double> interval_;
  std::function<void(const std::string& head)> changed_;
  std::map<std::string, FileIdentity> known_;
  std::string last_;  ///< looked at in this round; empty: it has not begun
  bool waiting_ = false;
  boost::asio::steady_timer timer_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();  ///< a handler may be on its way when the poll ends
};

}  // namespace weir
