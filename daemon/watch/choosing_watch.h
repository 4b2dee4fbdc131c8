// Watches a directory by inotify if this machine sees all changes of its file system, otherwise by polling.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>

#include "daemon/config/config.h"
#include "daemon/watch/directory_watch.h"
#include "daemon/watch/inotify.h"

namespace weir {

/// Watches config.directory from now on by the method config.watch. The method `automatic` uses inotify if it sees
/// all changes (file_system_kind.h), otherwise polling. If inotify's limits are reached, polling replaces it, and a
/// notice says so. Events of one file are merged within 20 ms, with polling within config.poll_interval_s.
std::unique_ptr<DirectoryWatch> make_directory_watch(boost::asio::io_context& io, const WatchConfig& config,
                                                     WatchListener listener);
/// For tests: uses the given inotify instead of the system's.
std::unique_ptr<DirectoryWatch> make_directory_watch(boost::asio::io_context& io, const WatchConfig& config,
                                                     WatchListener listener, OpenInotify open_inotify);

}  // namespace weir
