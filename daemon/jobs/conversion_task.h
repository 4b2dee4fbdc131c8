// What one job asks of the commands that do it.
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
  FileIdentity identity;                     ///< of the source as it was found complete
  std::string output;                        ///< as `weir convert -o` takes it: "DIRECTORY/" or "DIRECTORY/{stem}.nvdb"
  std::vector<std::string> convert_options;  ///< WatchConfig::convert_options
  std::string within;                        ///< the directory that the source's files must lie in; empty: anywhere
  std::uint64_t memory = 0;                  ///< bytes, of each process
  std::uint64_t bandwidth = 0;               ///< bytes per second that the conversion may read and write; 0: no limit
  int threads = 0;
  int nice = 0;
  IoClass io_class = IoClass::none;
  std::string work_dir;  ///< spill files; empty: beside the output
  bool thumbnails = true;
  bool again = false;         ///< also what is done
  bool count_values = false;  ///< of the source, which is deleted where the outputs have all of them
  /// Not empty: these were made and verified before, and their thumbnails are all there is to do.
  std::vector<JobOutput> outputs;
};

/// The task of `job`, which is of `watch`.
ConversionTask make_task(const std::string& program, const ServiceConfig& service, const WatchConfig& watch,
                         const Job& job);

/// The task of the thumbnails that are missing of `job`, which is done: of outputs that are still there. None where
/// there is nothing to render, or the watch wants none.
std::optional<ConversionTask> make_rendering_task(const std::string& program, const ServiceConfig& service,
                                                  const WatchConfig& watch, const Job& job);

/// Whether `source`, an absolute path, is named as one in the watch's directory or below it.
bool is_source_of(const WatchConfig& watch, const std::string& source);

/// Whether that holds, and the watch's include and exclude take it. Looks at the file system.
bool takes_source(const WatchConfig& watch, const std::string& source);

/// Where the outputs of `source`, which lies in the watch, go: the watch's output directory and below it the source's
/// own place in the tree. Ends without a slash.
std::string output_directory(const WatchConfig& watch, const std::string& source);

/// All of `watch` that decides what an output holds and where it lies, as text: JobStore::observe's `options`.
std::string options_text(const WatchConfig& watch);

}  // namespace weir
