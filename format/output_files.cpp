#include "format/output_files.h"

#include <span>
#include <utility>

#include "format/error.h"
#include "format/sidecar.h"
#include "format/text.h"

namespace weir {

std::string directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

OutputFiles::OutputFiles(FileSystem& files, const std::string& path, bool overwrite)
    : files_(files), path_(path), sidecar_(sidecar_path(path)), directory_(directory_of(path)), overwrite_(overwrite) {
  if (!files_.exists(directory_)) {
    throw Error(ErrorKind::io,
                cat(path, ": the directory ", directory_, " does not exist; make it or choose another output"));
  }
  if (!overwrite_) {
    const bool cut_short = files_.exists(path_ + ".partial");
    refuse_existing(path_);
    if (!cut_short) refuse_existing(sidecar_);
  }
  partial_ = files_.create(path_ + ".partial");
  if (overwrite_ || !files_.exists(sidecar_)) return;
  // A commit that was killed between its steps 4 and 5. Under the lock nobody is between them; who was may have come
  // to its end meanwhile.
  try {
    refuse_existing(path_);
    files_.remove(sidecar_);
  } catch (const Error&) {
    remove_quietly(path_ + ".partial");
    throw;
  }
}

void OutputFiles::refuse_existing(const std::string& path) {
  if (!files_.exists(path)) return;
  throw Error(ErrorKind::usage, cat(path, ": exists; choose another output with -o or pass --overwrite"));
}

void OutputFiles::write_to(std::shared_ptr<File> file) { volume_ = std::move(file); }

OutputFiles::~OutputFiles() {
  if (committed_) return;
  remove_quietly(path_ + ".partial");
  remove_quietly(sidecar_ + ".partial");
}

void OutputFiles::remove_quietly(const std::string& path) noexcept {
  try {
    files_.remove(path);
  } catch (const Error&) {
    // The failure that led here is the one to report.
  }
}

// What each step leaves if the machine stops after it:
//   1. volume.partial flushed           both names as before (nothing, or the old pair)
//   2. sidecar.partial written, flushed the same
//   3. old sidecar linked to .previous  the same, and a second name of the old sidecar
//   4. sidecar renamed into place       new sidecar beside no volume or the old one: its size and head
//                                       checksum do not agree, so `verify` and the daemon see "not done"; no
//                                       volume beside OUT.nvdb.partial, the lock that a kill leaves: the next
//                                       conversion replaces the sidecar
//   5. volume renamed into place        the new pair
//   6. .previous removed                the new pair alone
//   7. directory flushed                the new pair, durable
// A failure before step 5 has done its work puts the old sidecar back, or removes the new one.
void OutputFiles::commit(const std::string& sidecar_text) {
  const std::string volume_partial = volume().path();
  const std::string sidecar_partial = sidecar_ + ".partial";
  const std::string previous = sidecar_ + ".previous";
  volume().sync();  // 1
  {
    const std::unique_ptr<File> file = files_.create(sidecar_partial);  // 2
    file->write_at(0, std::as_bytes(std::span(sidecar_text)));
    file->sync();
  }
  const bool replaces = overwrite_ && files_.exists(sidecar_);
  if (replaces) {
    files_.remove(previous);          // of an earlier crash
    files_.link(sidecar_, previous);  // 3
  }
  bool sidecar_placed = false;
  try {
    if (overwrite_) {
      files_.rename(sidecar_partial, sidecar_);  // 4
      sidecar_placed = true;
      files_.rename(volume_partial, path_);  // 5
    } else {
      files_.rename_new(sidecar_partial, sidecar_);
      sidecar_placed = true;
      files_.rename_new(volume_partial, path_);
    }
  } catch (const Error&) {
    if (replaces) {
      try {
        files_.rename(previous, sidecar_);
        files_.remove(previous);  // still there where both were names of one file
      } catch (const Error&) {
        // The old sidecar stays under .previous; the volume's name was not touched.
      }
    } else if (sidecar_placed) {
      remove_quietly(sidecar_);
    }
    throw;
  }
  committed_ = true;
  if (volume_) remove_quietly(path_ + ".partial");
  if (replaces) remove_quietly(previous);  // 6
  files_.sync_directory(directory_);       // 7
}

}  // namespace weir
