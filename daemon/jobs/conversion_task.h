// Everything that the commands of one job need to know.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/store/job.h"

namespace weir {

struct ConversionTask {
  std::string program;                       ///< path of `weir`
  std::string source;                        ///< absolute path
  FileIdentity identity;                     ///< of the source when it was found complete
  std::string output;                        ///< as `weir convert -o` takes it: "DIRECTORY/" or "DIRECTORY/{stem}.nvdb"
  std::vector<std::string> convert_options;  ///< WatchConfig::convert_options
  std::string within;                        ///< the directory that the source's files must lie in; empty: anywhere
  std::uint64_t memory = 0;                  ///< bytes that each process may take
  std::uint64_t bandwidth = 0;               ///< bytes per second that the conversion may read and write; 0: no limit
  int threads = 0;
  int nice = 0;
  IoClass io_class = IoClass::none;
  std::string work_dir;  ///< directory of spill files; empty: beside the output
  bool thumbnails = true;
  bool again = false;         ///< also convert outputs that are done already
  bool count_values = false;  ///< count the source's values: the source is deleted if the outputs hold all of them
  /// Outputs of an earlier run that are already verified. If there are any, only their thumbnails are rendered.
  std::vector<JobOutput> outputs;
};

/// Returns the task of `job`, a job of `watch`.
ConversionTask make_task(const std::string& program, const ServiceConfig& service, const WatchConfig& watch,
                         const Job& job);

/// Returns the task that renders the missing thumbnails of `job`, a done job, for the outputs that still exist.
/// Returns none if there is nothing to render or the watch wants no thumbnails.
std::optional<ConversionTask> make_rendering_task(const std::string& program, const ServiceConfig& service,
                                                  const WatchConfig& watch, const Job& job);

/// Returns whether the absolute path `source` lies, by its name, in the watch's directory or below it.
bool is_source_of(const WatchConfig& watch, const std::string& source);

/// Returns whether is_source_of() holds and the watch's include and exclude patterns accept `source`. Reads the file
/// system.
bool takes_source(const WatchConfig& watch, const std::string& source);

/// Returns the directory of the outputs of `source`, a source of `watch`: the watch's output directory, extended by
/// the source's own place in the tree. The path ends without a slash.
std::string output_directory(const WatchConfig& watch, const std::string& source);

/// Returns as text all settings of `watch` that decide what an output holds and where it lies: the `options` of
/// JobStore::observe.
std::string options_text(const WatchConfig& watch);

}  // namespace weir
