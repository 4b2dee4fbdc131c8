#include "format/output/partial_file.h"

#include <unistd.h>

#include <cerrno>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/output/output_place.h"

namespace weir {

PartialFile::PartialFile(FileSystem& files, const std::string& path, bool overwrite)
    : files_(files), owner_(::getpid()), path_(path), overwrite_(overwrite) {
  require_place(files_, path, kPartialEnding.size());
  if (!overwrite) refuse_existing(files_, path);
  file_ = files_.create(partial_path(path));
  require_alone(*file_);
}

PartialFile::~PartialFile() {
  if (committed_ || owner_ != ::getpid()) return;
  try {
    if (file_->has_its_name()) files_.remove(partial_path(path_));
  } catch (const Error&) {
    // The earlier failure is the one to report.
  }
}

void PartialFile::reserve(std::uint64_t bytes) {
  if (file_->preallocate(bytes)) return;
  const std::uint64_t free = files_.free_bytes(directory_of(path_));
  if (free < bytes) throw io_error(path_, cat("reserve ", bytes, " bytes where ", free, " are free"), ENOSPC);
}

void PartialFile::commit() {
  const std::string partial = partial_path(path_);
  file_->sync();  // 1
  require_named(*file_);
  if (overwrite_) {
    files_.rename(partial, path_);  // 2
  } else {
    place_new(files_, partial, path_);
  }
  committed_ = true;
  flush_name(files_, path_);  // 3
}

}  // namespace weir
