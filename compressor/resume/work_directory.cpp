#include "compressor/resume/work_directory.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"

namespace weir {

std::string hidden_directory_of(const std::string& output) {
  const std::size_t slash = output.rfind('/');
  return cat(directory_of(output), '/', work_name(slash == std::string::npos ? output : output.substr(slash + 1)));
}

void remove_if_empty(FileSystem& files, const std::string& path) noexcept {
  try {
    files.remove_directory(path);
  } catch (const Error&) {
    // The directory is not empty.
  }
}

void check_work_directory(FileSystem& files, const std::string& chosen) {
  std::error_code why;
  const std::filesystem::file_status status = std::filesystem::status(chosen, why);
  if (!files.exists(chosen)) {
    // No directory can be made below a file or behind a circle of links.
    if (why && why != std::errc::no_such_file_or_directory) {
      throw io_error(chosen, compose("be ", option("work-dir")), why.value());
    }
    throw Error(ErrorKind::io, compose(option("work-dir", chosen), ": does not exist; make it or choose another"),
                SystemFailure{ENOENT, chosen});
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_directory(status))
    throw Error(ErrorKind::usage, compose(option("work-dir", chosen), ": is a file; choose a directory"));
  if (files.is_memory(chosen)) {
    throw Error(ErrorKind::usage,
                compose(option("work-dir", chosen), ": is a memory file system; choose a directory on a disk"));
  }
}

WorkDirectory::WorkDirectory(FileSystem& files, const std::string& output, const std::string& chosen) : files_(files) {
  if (!chosen.empty()) {
    check_work_directory(files, chosen);
    path_ = chosen;
    return;
  }
  const std::string directory = directory_of(output);
  if (files_.is_memory(directory)) {
    // Spill files beside the output would use memory that no ceiling counts.
    path_ = "/var/tmp";
    if (!files_.exists(path_) || files_.is_memory(path_)) {
      throw Error(
          ErrorKind::usage,
          compose(output, ": lies on a memory file system, and so does /var/tmp; name a directory on a disk with ",
                  option("work-dir")));
    }
    return;
  }
  path_ = hidden_directory_of(output);
  files_.make_directory(path_);
  made_ = true;
}

WorkDirectory::~WorkDirectory() {
  if (made_) remove_if_empty(files_, path_);
}

}  // namespace weir
