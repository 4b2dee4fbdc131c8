// When a source is whole. Pure: it is told what happened to the file (FileEvent), what the file looks like
// (FileSample) and what time it is, and answers. Clocks may jump: times are steady, a file's mtime is only
// compared for equality.
//
// Policies (WatchConfig::complete), each also without a change for kCloseSettle or `settle` where it says so:
//   close   a writer closed it; found without its writer: unchanged for settle
//   rename  it has its name by a rename; found without its writer: at once, but where a program has it open for
//           writing, which may have begun before its directory was watched, when none has, and it is unchanged for
//           settle; created or linked: not before a rename
//   marker  NAME.done is beside it, unchanged for kCloseSettle
//   size    it has its expected size, unchanged for kCloseSettle; shorter and closed: unchanged for settle; of a
//           directory, which has none: as stable
//   stable  unchanged for settle
//   auto    renamed: at once
//           closed: at once where its expected size is known and reached, else unchanged for kCloseSettle
//           being written and its close will be seen: that is waited for, however long
//           found without its writer, or linked: unchanged for settle
// An empty file is waited for unless its writer closed or renamed it. A file that is complete by its policy and empty,
// or of another size than expected, is broken. A plotfile of AMReX is judged by its Header, which may be written before
// its values: what else it needs is looked for every `settle`. A Zarr hierarchy in a directory is complete when nothing
// in it has changed for `settle` (store_quiet.h), with the policy marker when its marker is there.
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

/// After a close: time for a second writer, or the same one, to open the file again.
inline constexpr std::chrono::milliseconds kCloseSettle{200};

struct CompletionRules {
  Completion policy = Completion::automatic;
  std::chrono::nanoseconds settle{std::chrono::seconds{2}};
  std::optional<std::uint64_t> expected_bytes;  ///< of the file, where its name or the options say it
  std::string marker;                           ///< of the policy marker, for messages
  /// Of a source in several files, asked once its own is whole: what is not written yet, in words; empty where all is.
  std::function<std::string()> unwritten;
  /// With the policy rename, of a file that was found: whether a program has it open for writing.
  std::function<bool()> has_writer;
  /// Of a source in files that nothing lists, asked like that.
  std::shared_ptr<StoreQuiet> store;
};

/// The rules for `path`, a source of `watch`. The expected size is that of a raw file: NAME_XxYxZ_TYPE.raw or
/// dims and type (and offset) among the convert options.
/// `turns`: where there are several Zarr hierarchies.
CompletionRules completion_rules(const WatchConfig& watch, const std::string& path,
                                 const std::shared_ptr<StoreTurns>& turns = {});

/// What a path looks like now.
struct FileSample {
  /// As a regular file, behind links too; a Header as that of a plotfile, a file of Zarr as the one that format_of
  /// takes.
  bool exists = false;
  FileIdentity identity;
  bool marked = false;  ///< path + marker exists
};

/// Looks at the file system. `marker` empty: not looked for. `convert_options` say which metadata of a Zarr hierarchy
/// belong to the source (identify_source). Throws Error(io) where it cannot be looked at for another reason than that
/// nothing is there.
FileSample sample_file(const std::string& path, const std::string& marker,
                       const std::vector<std::string>& convert_options = {});

struct CompletionAnswer {
  enum class State {
    complete,  ///< convert it, in the state of the sample
    waiting,   ///< look again with a new sample at `until`, or after the next event
    broken,    ///< whole as far as its writer is concerned, and useless; until the next event
    gone       ///< not there
  };
  State state = State::waiting;
  std::chrono::steady_clock::time_point until{};  ///< of waiting; time_point::max(): not before the next event
  std::string reason;                             ///< of waiting, in words; of broken, one line without the path
};

/// Follows one file until it is complete. Made when the first event of the file arrives, and given all of them; small
/// (and may be dropped when it is complete, broken or gone: the next event makes a new one).
class FileCompletion {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit FileCompletion(CompletionRules rules) : rules_(std::move(rules)) {}

  /// Something happened to the file. found, created, written, closed, moved_in, marked and overflow mean something,
  /// others are ignored. A sample must follow at once.
  void happened(FileEventKind kind, Time now);
  CompletionAnswer look(const FileSample& sample, Time now);

 private:
  enum class Writer { unknown, begun, open, closed, renamed };  ///< begun: it was made, or linked, and not written to

  CompletionAnswer by_policy(const FileSample& sample, Time now);
  // When to ask again what no event will tell.
  Time asked_again(Time now) const;
  CompletionAnswer when_renamed(Time now);
  CompletionAnswer when_unchanged(std::chrono::nanoseconds settle, Time now) const;
  CompletionAnswer whole() const;

  CompletionRules rules_;
  Writer writer_ = Writer::unknown;
  bool found_open_ = false;  // it was found, with a writer; events of that one say nothing about its name
  std::optional<FileIdentity> seen_;
  Time unchanged_since_{};
};

}  // namespace weir
