#include "ingest/files/file_state.h"

#include <filesystem>
#include <system_error>

#include "format/base/text.h"
#include "format/io/file_time.h"
#include "format/io/real_path.h"
#include "format/sidecar/sidecar.h"

namespace weir {
namespace {

std::int64_t nanoseconds(const timespec& time) { return nanoseconds_of(time.tv_sec, time.tv_nsec); }

// Returns what happened to a file that has changed.
std::string difference(const FileState& before, const FileState& now) {
  if (!now.exists) return "it is not there any more";
  if (!before.exists) return "it was not there before";
  if (now.inode != before.inode || now.device != before.device) return "another file has taken its place";
  if (now.bytes != before.bytes) return cat("it had ", before.bytes, " bytes and has ", now.bytes);
  if (now.mtime_ns != before.mtime_ns) {
    return cat("it was written to at ", utc_text(now.mtime_ns), ", the last time before that at ",
               utc_text(before.mtime_ns));
  }
  return cat("its content, name or rights were changed at ", utc_text(now.ctime_ns));
}

}  // namespace

FileState state_of(const std::string& path, const struct stat& status) {
  return {path,
          true,
          static_cast<std::uint64_t>(status.st_dev),
          static_cast<std::uint64_t>(status.st_ino),
          static_cast<std::uint64_t>(status.st_size),
          nanoseconds(status.st_mtim),
          nanoseconds(status.st_ctim)};
}

FileState look_at_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return state_of(path, status);
  FileState missing;
  missing.path = path;
  return missing;
}

std::int64_t tick_of(std::int64_t time_ns) { return time_ns % 1'000'000'000 == 0 ? 2'000'000'000 : 0; }

bool touched_since(const FileState& file, const FileState& record) {
  // Times within one tick of the clock count as equal, so they count as touched.
  return file.ctime_ns + tick_of(file.ctime_ns) >= record.mtime_ns;
}

Error changed_error(const std::string& path, const std::string& what) {
  return input_error(path, cat(kChangedWhileRead, ": ", what, kConvertAgain));
}

void check_unchanged(std::span<const FileState> files) {
  for (const FileState& before : files) {
    const FileState now = look_at_file(before.path);
    if (now != before) throw changed_error(before.path, difference(before, now));
  }
}

std::optional<std::string> file_outside(std::span<const FileState> files, const std::string& directory) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path inside = fs::canonical(directory, error);
  if (error) throw Error(ErrorKind::input, cat(directory, ": look at the directory: ", error.message()));
  for (const FileState& file : files) {
    const fs::path target = fs::weakly_canonical(file.path, error);
    if (error) return file.path;
    if (!lies_below(target, inside)) return target.string();
    const FileState now = look_at_file(target.string());
    if (now.device != file.device || now.inode != file.inode) return file.path;
  }
  return std::nullopt;
}

}  // namespace weir
