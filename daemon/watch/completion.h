// Decides when a source is complete. Pure: the caller passes the events of the file (FileEvent), its present state
// (FileSample) and the time. Clocks may jump, so times are steady, and a file's mtime is only compared for equality.
//
// Policies (WatchConfig::complete). Some also ask that the file is unchanged for kCloseSettle or `settle`:
//   close   a writer closed the file. Found without its writer: no program has it open for writing, and it is
//           unchanged for settle
//   rename  the file got its name by a rename. Found without its writer: complete at once; but if a program has it
//           open for writing (it may have begun before its directory was watched), complete when no program has and
//           it is unchanged for settle. Rewritten in place after a rename or after it was found: complete likewise.
//           Created or linked: not before a rename
//   marker  NAME.done is beside the file, and the file is unchanged for kCloseSettle
//   size    the file has its expected size and is unchanged for kCloseSettle. Shorter and closed: unchanged for
//           settle. A directory has no expected size: as stable
//   stable  the file is unchanged for settle
//   auto    renamed: complete at once
//           closed: complete at once if its expected size is known and reached, otherwise unchanged for kCloseSettle
//           being written by a program whose close will be seen: complete only after the close, however late
//           found without its writer, or linked: unchanged for settle
// An empty file is not complete unless its writer closed or renamed it. A file that is complete by its policy but
// empty, or not of its expected size, is broken. An AMReX plotfile is judged by its Header, which may be written
// before the values: its other files are checked every `settle`. A Zarr hierarchy in a directory is complete when
// nothing in it has changed for `settle` (store_quiet.h); with the policy marker, when its marker is there.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/store/job.h"
#include "daemon/watch/file_event.h"
#include "daemon/watch/store_quiet.h"

namespace weir {

/// Wait after a close: time for a second writer, or the same one, to open the file again.
inline constexpr std::chrono::milliseconds kCloseSettle{200};

struct CompletionRules {
  Completion policy = Completion::automatic;
  std::chrono::nanoseconds settle{std::chrono::seconds{2}};
  std::optional<std::uint64_t> expected_bytes;  ///< size of the file, if its name or the options give it
  std::string marker;                           ///< ending of the marker's name for the policy marker; used in messages
  /// For a source in several files, called when its first file is complete. Returns in words what is not written yet;
  /// empty if all is.
  std::function<std::string()> unwritten;
  /// For the policies rename and close, called for a found file: returns whether a program has it open for writing.
  std::function<bool()> has_writer;
  /// For a source whose files nothing lists (a Zarr hierarchy), asked when its first file is complete.
  std::shared_ptr<StoreQuiet> store;
};

/// Returns the rules for `path`, a source of `watch`. A raw file has an expected size if its name is
/// NAME_XxYxZ_TYPE.raw, or if the convert options have dims and type (and offset). Several Zarr hierarchies share
/// `turns`.
CompletionRules completion_rules(const WatchConfig& watch, const std::string& path,
                                 const std::shared_ptr<StoreTurns>& turns = {});

/// The present state of a path.
struct FileSample {
  /// Whether a regular file is there, also behind links. A Header must be that of a plotfile, and a file of Zarr must
  /// be the one that format_of takes.
  bool exists = false;
  FileIdentity identity;
  bool marked = false;  ///< path + marker exists
};

/// Reads the file system. An empty `marker` is not looked for. `convert_options` select the metadata of a Zarr
/// hierarchy that belong to the source (identify_source). Throws Error(io) if the path cannot be looked at for
/// another reason than that nothing is there.
FileSample sample_file(const std::string& path, const std::string& marker,
                       const std::vector<std::string>& convert_options = {});

struct CompletionAnswer {
  enum class State {
    complete,  ///< convert the file in the state of the sample
    waiting,   ///< look again with a new sample at `until`, or after the next event
    broken,    ///< complete for its writer, but unusable; stays so until the next event
    gone       ///< not there
  };
  State state = State::waiting;
  std::chrono::steady_clock::time_point until{};  ///< for waiting; time_point::max(): not before the next event
  std::string reason;                             ///< for waiting: in words; for broken: one line without the path
};

/// Follows one file until it is complete. Created at the file's first event, and given all its events. The object is
/// small, and may be dropped when the file is complete, broken or gone: the next event creates a new one.
class FileCompletion {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit FileCompletion(CompletionRules rules) : rules_(std::move(rules)) {}

  /// Records an event. found, created, written, closed, moved_in and overflow tell of the writer. The others only end
  /// the state "found while a writer had it open". look() must be called at once with a new sample.
  void happened(FileEventKind kind, Time now);
  CompletionAnswer look(const FileSample& sample, Time now);
  /// Tells that the file was a source before and has changed. Unless it was created anew since, it has its name.
  void source_before();

 private:
  // begun: the file was created or linked, and not written to.
  enum class Writer { unknown, begun, open, closed, renamed };

  void set_named(bool named);
  CompletionAnswer by_policy(const FileSample& sample, Time now);
  // Returns when to check again for a change that no event reports.
  Time asked_again(Time now) const;
  CompletionAnswer when_renamed(Time now);
  CompletionAnswer when_unchanged(std::chrono::nanoseconds settle, Time now) const;
  CompletionAnswer whole() const;

  CompletionRules rules_;
  Writer writer_ = Writer::unknown;
  bool created_ = false;  ///< under this name, by the last event that says how it got its name
  bool named_ = false;    ///< it has its name by a rename, or was found with it
  // The file was found while a writer had it open. Events of that writer say nothing about its name.
  bool found_open_ = false;
  std::optional<FileIdentity> seen_;
  Time unchanged_since_{};
};

}  // namespace weir
