// Watches a directory by inotify where the file system's changes pass through this machine, elsewhere by polling.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>

#include "daemon/config/config.h"
#include "daemon/watch/directory_watch.h"
#include "daemon/watch/inotify.h"

namespace weir {

/// Watches config.directory from now on by config.watch. automatic: inotify where it sees everything
/// (file_system_kind.h), else polling; inotify whose limits are reached becomes polling and a notice says so.
/// Events of one file are merged within 20 ms, by polling within config.poll_interval_s.
std::unique_ptr<DirectoryWatch> make_directory_watch(boost::asio::io_context& io, const WatchConfig& config,
                                                     WatchListener listener);
/// The same with another inotify than the system's, for tests.
std::unique_ptr<DirectoryWatch> make_directory_watch(boost::asio::io_context& io, const WatchConfig& config,
                                                     WatchListener listener, OpenInotify open_inotify);

}  // namespace weir
