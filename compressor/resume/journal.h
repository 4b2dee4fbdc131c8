// Lets a conversion continue after its process has ended. The files that it depends on have names, and a journal says
// how much of them can be trusted.
//
// The hidden directory beside the output holds `journal`, a Checkpoint, and `volume`, the unfinished OUT.nvdb. The
// spill directory holds `rows`, `faces`, `ladders` and `records`; it is the same directory unless the user names
// another. A save has four steps:
//   1. flush all files                  what the checkpoint says of them is then durable
//   2. write and flush journal.new
//   3. rename journal.new to journal    the old or the new checkpoint counts, never half of one
//   4. flush the directories            at the first save their own names, too
// A save runs beside the work, so that a pass does not wait for the disk. Whatever a pass writes after the last save is
// written again when the conversion continues: the same bytes at the same places.
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compressor/resume/checkpoint.h"
#include "format/base/message.h"
#include "format/base/trace.h"
#include "format/io/file_system.h"

namespace weir {

struct JournalOptions {
  std::string work_dir;   ///< where spill files go; empty: beside the output
  double interval_s = 0;  ///< seconds between two saves; 0: save at every pause and wait for each save
  const std::atomic<bool>* cancel = nullptr;  ///< once set, everything is saved at the next pause
  Trace* trace = nullptr;                     ///< gets a "save" span for each save
  Notice notice;                              ///< may be empty
};

/// Only one thread may use a Journal. The lock on the output (OutputFiles) must be held for the journal's whole life.
class Journal {
 public:
  /// Loads into `state` what an interrupted conversion with the same identity left at `output`. Leftovers of another
  /// conversion, and damaged ones, are removed with a notice. Throws Error(io) if another host or container has an
  /// output with the same path and spill files in the same work directory; these files stay.
  Journal(FileSystem& files, const std::string& output, ConversionIdentity identity, JournalOptions options);
  /// Removes everything that no saved checkpoint depends on.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The progress of the conversion. The conversion changes and saves it.
  Checkpoint state;

  /// Returns the output as the constructor was given it.
  const std::string& output() const { return output_; }
  const std::string& directory() const { return directory_; }
  /// Returns the path of a file that open() opens.
  std::string path_of(const std::string& name) const;
  /// Returns the paths of everything that discard() removes, in the same order.
  std::vector<std::string> paths() const;

  /// Opens "rows", "faces", "ladders", "records" or "volume" and keeps its content.
  std::shared_ptr<File> open(const std::string& name);

  /// Returns whether it is time for a save. Throws the error of the last save if that failed.
  bool due();
  /// Saves the current `state` in the background. Waits for the save if the interval is 0 or the work is cancelled.
  void save();
  void save_now();

  /// Returns whether another process could continue if this one ended now.
  bool resumable() const { return !saved_.empty(); }

  /// Discards the progress of an earlier process, with a notice that gives `reason`. `state` becomes the state of a new
  /// conversion. Open files stay open and keep their content.
  void forget(const std::string& reason);

  /// Removes everything, the journal first. A file that cannot be removed stays.
  void discard() noexcept;

 private:
  using Clock = std::chrono::steady_clock;

  void say_not_continued(const std::string& reason);
  void adopt(const std::string& output, const ConversionIdentity& identity);
  bool adopts(const Checkpoint& found);
  void hold_spill_directory();
  void write(const std::vector<std::shared_ptr<File>>& open, const std::string& text);
  void wait();

  FileSystem& files_;
  std::string output_;
  JournalOptions options_;
  std::string directory_;
  std::string spill_directory_;  // Checkpoint::spill_directory
  std::map<std::string, std::shared_ptr<File>> open_;
  Clock::time_point last_save_ = Clock::now();
  std::future<void> saving_;
  bool placed_ = false;  // whether the names of the directories are durable
  std::map<std::string, std::uint64_t> saving_files_;
  std::map<std::string, std::uint64_t> saved_;  // files of the checkpoint that counts; empty: no checkpoint counts
};

/// Returns the checkpoint in the hidden directory of `output`, if it is whole and the files that it names exist.
std::optional<Checkpoint> read_journal(FileSystem& files, const std::string& output);

/// Removes everything that a conversion to `output` left for a continuation; returns false if there was nothing. The
/// caller must hold the lock on the output. Throws Error(io) if spill files of the output are being written.
bool remove_leftovers(FileSystem& files, const std::string& output);
/// Returns the notice that remove_leftovers() removed something of `output`.
std::string leftovers_notice(const std::string& output);

}  // namespace weir
