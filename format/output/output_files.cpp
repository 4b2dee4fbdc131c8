#include "format/output/output_files.h"

#include <unistd.h>

#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/mapped_writes.h"
#include "format/io/output_names.h"
#include "format/output/commit_leftovers.h"
#include "format/output/output_place.h"
#include "format/sidecar/sidecar.h"

namespace weir {

OutputFiles::OutputFiles(FileSystem& files, const std::string& path, bool overwrite)
    : files_(files),
      owner_(::getpid()),
      path_(path),
      sidecar_(sidecar_path(path)),
      directory_(directory_of(path)),
      overwrite_(overwrite) {
  require_volume_name(path_);
  require_place(files_, path_, previous_path(sidecar_).size() - path_.size());
  require_place(files_, sidecar_, kPreviousEnding.size());
  const std::string partial = partial_path(path_);
  const bool left_over = files_.exists(partial);
  if (!overwrite_) {
    refuse_existing(files_, path_);
    if (!left_over) refuse_existing(files_, sidecar_);
  }
  // The content that a killed process left tells which volume the sidecar belongs to, until create() empties the file.
  partial_ = left_over ? files_.open(partial) : files_.create(partial);
  require_alone(*partial_);
  try {
    undo_killed_commit(left_over);
    if (!left_over) return;
    partial_.reset();
    partial_ = files_.create(partial);
    require_alone(*partial_);
  } catch (const Error&) {
    if (!left_over) remove_quietly(partial);
    throw;
  }
}

// Repairs what a commit that was killed between its steps 4 and 5 left. Under the lock no other process is between
// them, but one that was may have finished before this process got the lock.
void OutputFiles::undo_killed_commit(bool left_over) {
  if (const std::string partial = partial_path(sidecar_); files_.exists(partial)) {
    files_.create(partial);  // refuses somebody else's file now, not when the work is done
    files_.remove(partial);
  }
  if (overwrite_) return restore_previous(left_over);
  if (!files_.exists(sidecar_)) return;
  refuse_existing(files_, path_);
  if (!left_over || !placed_by_commit(files_, sidecar_, *partial_)) refuse_existing(files_, sidecar_);
  files_.remove(sidecar_);
}

// Gives the old volume its own sidecar back, or none if it had none. Otherwise the next commit would take the killed
// commit's sidecar, which lies beside the volume, for the volume's own.
void OutputFiles::restore_previous(bool left_over) {
  if (!files_.exists(path_)) return;
  if (const std::string previous = previous_path(sidecar_); files_.exists(previous)) {
    if (belongs_back(files_, previous, sidecar_, path_)) files_.rename(previous, sidecar_);
  } else if (left_over && files_.exists(sidecar_) && came_too_early(files_, sidecar_, path_, *partial_)) {
    files_.remove(sidecar_);
  }
}

// Keeps the old sidecar by a second name, which takes no space; if the file system has no links, by a copy.
void OutputFiles::keep_previous(const std::string& previous) {
  files_.remove(previous);  // left by an earlier crash
  if (files_.link(sidecar_, previous)) return;
  try {
    const std::unique_ptr<File> from = files_.open_to_read(sidecar_);
    std::vector<std::byte> text(from->size());
    from->read_at(0, text);
    const std::unique_ptr<File> to = files_.create(previous);
    to->write_at(0, text);
    to->sync();
  } catch (const Error&) {
    remove_quietly(previous);
    throw;
  }
}

void OutputFiles::require_names() const {
  require_named(*partial_);
  if (volume_) require_named(*volume_);
}

void OutputFiles::write_to(std::shared_ptr<File> file) { volume_ = std::move(file); }

void OutputFiles::reserve_ahead(std::uint64_t bytes, Pages pages) {
  ahead_bytes_ = bytes;
  const bool clears = pages == Pages::cleared && in_memory();
  const auto preallocate = [this, &file = volume(), bytes, clears] {
    try {
      if (!file.preallocate(bytes)) return false;
      if (clears) clear_reserved_pages(file, bytes, enough_ahead_);
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  try {
    ahead_ = std::async(std::launch::async, preallocate);
  } catch (const std::system_error&) {
    // No thread is available: nothing is reserved ahead.
  }
}

void OutputFiles::clear_for(std::uint64_t bytes) {
  reserved_.reset();
  enough_ahead_ = true;
  if (ahead_.valid() && ahead_.get() && ahead_bytes_ == bytes) {
    reserved_ = bytes;
    return;
  }
  volume().clear();
}

OutputFiles::~OutputFiles() {
  if (owner_ != ::getpid()) {
    // The future is leaked, because destroying it would wait for a thread of the parent.
    static_cast<void>(std::make_unique<std::future<bool>>(std::move(ahead_)).release());
    return;
  }
  enough_ahead_ = true;
  if (ahead_.valid()) ahead_.wait();
  if (committed_ && !volume_) return;
  if (!holds_lock()) return;  // another process has these names now
  // A volume written to another file: its lock goes only now, after the data that the volume was made from.
  remove_quietly(partial_path(path_));
  if (!committed_) remove_quietly(partial_path(sidecar_));
}

bool OutputFiles::holds_lock() const noexcept {
  try {
    return partial_->has_its_name();
  } catch (const Error&) {
    return false;
  }
}

void OutputFiles::remove_quietly(const std::string& path) noexcept {
  try {
    files_.remove(path);
  } catch (const Error&) {
    // The earlier failure is the one to report.
  }
}

// What each step leaves if the machine stops after it:
//   1. volume.partial flushed           both names as before (nothing, or the old pair); if it is only a lock, it
//                                       holds the digest of the future sidecar
//   2. sidecar.partial written, flushed the same
//   3. old sidecar linked to .previous  the same, and a second name of the old sidecar, or a copy of it
//   4. sidecar renamed into place       new sidecar beside no volume, or beside the old one, which may have the same
//                                       size and head checksum. Beside .previous or OUT.nvdb.partial all readers
//                                       compare the digest of the volume's bytes and see "not done". No volume,
//                                       and OUT.nvdb.partial agrees with the sidecar: the next conversion
//                                       replaces the sidecar. The next --overwrite of the old volume first puts
//                                       the volume's own sidecar back
//   5. volume renamed into place        the new pair
//   6. .previous removed                the new pair alone
//   7. directory flushed                the new pair, durable
// A failure before the end of step 5 puts the old sidecar back, or removes the new one. Steps 2 and 4 first check
// whether the lock and the volume still have their names.
void OutputFiles::commit(const std::string& sidecar_text) {
  const std::string volume_partial = volume().path();
  const std::string sidecar_partial = partial_path(sidecar_);
  const std::string previous = previous_path(sidecar_);
  volume().sync();  // 1
  if (volume_) {
    const std::string record = commit_record(sidecar_text);
    partial_->write_at(0, std::as_bytes(std::span(record)));
    partial_->sync();
  }
  require_names();
  {
    const std::unique_ptr<File> file = files_.create(sidecar_partial);  // 2
    file->write_at(0, std::as_bytes(std::span(sidecar_text)));
    file->sync();
  }
  const bool replaces = overwrite_ && files_.exists(sidecar_);
  if (replaces) keep_previous(previous);  // 3
  bool sidecar_placed = false;
  try {
    require_names();
    if (overwrite_) {
      files_.rename(sidecar_partial, sidecar_);  // 4
      sidecar_placed = true;
      files_.rename(volume_partial, path_);  // 5
    } else {
      place_new(files_, sidecar_partial, sidecar_);
      sidecar_placed = true;
      place_new(files_, volume_partial, path_);
    }
  } catch (const Error&) {
    if (replaces) {
      try {
        files_.rename(previous, sidecar_);
        files_.remove(previous);  // still there if both were names of one file
      } catch (const Error&) {
        // The old sidecar stays under .previous; the volume's name was not touched.
      }
    } else if (sidecar_placed) {
      remove_quietly(sidecar_);
    }
    throw;
  }
  committed_ = true;
  if (replaces) remove_quietly(previous);  // 6
  flush_name(files_, path_);               // 7
}

}  // namespace weir
