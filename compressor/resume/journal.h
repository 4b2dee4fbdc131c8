// Lets a conversion continue after its process has ended: the files it depends on have names, and a journal says how
// far they can be trusted.
//
// In the hidden directory beside the output: `journal`, a Checkpoint, and
// `volume`, the unfinished OUT.nvdb. In the spill directory, which is the same
// unless the user names another: `rows`, `faces`, `ladders` and `records`. A save is
//   1. all files flushed                what the checkpoint says of them is durable
//   2. journal.new written and flushed
//   3. journal.new renamed to journal   the checkpoint counts: the old or the new one, never half of one
//   4. the directories flushed, at the first save their own names, too
// and runs beside the work, so that a pass waits for no device. What is written
// after a save and before the next is written again, the same bytes at the same
// places.
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
  double interval_s = 0;  ///< between two saves; 0: whenever there is something to save, and each is waited for
  const std::atomic<bool>* cancel = nullptr;  ///< once set, everything is saved at the next pause
  Trace* trace = nullptr;                     ///< gets a "save" of each
  Notice notice;                              ///< may be empty
};

/// One thread uses it. The lock on the output (OutputFiles) must be held longer than it lives.
class Journal {
 public:
  /// Takes up what an interrupted conversion of that identity left at `output`, in `state`. What another one left, or
  /// what is not whole, is removed, with a notice. Throws Error(io) where another host or container, whose output has
  /// the same path, has spill files in the same work directory: they stay.
  Journal(FileSystem& files, const std::string& output, ConversionIdentity identity, JournalOptions options);
  /// Removes everything that no saved checkpoint depends on.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// How far the conversion is; the conversion changes and saves it.
  Checkpoint state;

  /// As it was given.
  const std::string& output() const { return output_; }
  const std::string& directory() const { return directory_; }
  /// Of a file that open() gives.
  std::string path_of(const std::string& name) const;
  /// Of all that discard() removes, in its order.
  std::vector<std::string> paths() const;

  /// "rows", "faces", "ladders", "records" or "volume", with what is in it.
  std::shared_ptr<File> open(const std::string& name);

  /// Whether the time for a save has come. Throws what the last one failed with.
  bool due();
  /// Saves `state` as it is now, beside the work unless the interval is 0 or the work is to end.
  void save();
  void save_now();

  /// Whether a process could go on from here if this one ended.
  bool resumable() const { return !saved_.empty(); }

  /// Nothing of what an earlier process left counts any more, with a notice of `reason`: `state` is that of a new
  /// conversion. Open files stay open, with what is in them.
  void forget(const std::string& reason);

  /// Removes everything, the journal first; what cannot be removed stays.
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
  std::map<std::string, std::uint64_t> saved_;  // files of the checkpoint that counts; empty: none does
};

/// What the journal in the hidden directory of `output` says, if it is whole and the files it names are there.
std::optional<Checkpoint> read_journal(FileSystem& files, const std::string& output);

/// Removes whatever a conversion of `output` may have left to be continued; false where there is nothing. The caller
/// holds the lock on the output. Throws Error(io) where spill files of it are being written.
bool remove_leftovers(FileSystem& files, const std::string& output);
/// The notice that it was true of `output`.
std::string leftovers_notice(const std::string& output);

}  // namespace weir
