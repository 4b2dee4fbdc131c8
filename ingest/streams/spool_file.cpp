#include "ingest/streams/spool_file.h"

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"

namespace weir {
namespace {

// Systems keep this directory on a disk and clear it (FHS 3.0, section 5.15).
constexpr const char* kDiskDirectory = "/var/tmp";

std::unique_ptr<File> create_spool(FileSystem& files, const std::string& chosen, const std::string& packed_path) {
  const std::string directory = chosen.empty() ? directory_of(packed_path) : chosen;
  if (!files.is_memory(directory)) {
    try {
      return files.create_unnamed(directory);
    } catch (const Error&) {
      if (!chosen.empty()) throw;  // data often lies in read-only directories; a chosen one must work
    }
  }
  // On a memory file system, unpacking would take memory that no ceiling counts.
  if (!files.exists(kDiskDirectory) || files.is_memory(kDiskDirectory)) {
    throw Error(ErrorKind::io, compose(packed_path, ": must be unpacked, but ", directory, " and ", kDiskDirectory,
                                       " are no writable directories on a disk; name one with ", option("work-dir")));
  }
  return files.create_unnamed(kDiskDirectory);
}

}  // namespace

SpoolFile::SpoolFile(FileSystem& files, const SourceOptions& options, std::string packed_path, std::uint64_t bytes)
    : packed_path_(std::move(packed_path)),
      bytes_(bytes),
      direct_io_(options.direct_io),
      cancel_(options.cancel),
      file_(create_spool(files, options.spool_directory, packed_path_)) {
  file_->preallocate(bytes);
}

void SpoolFile::check_cancel() const {
  if (cancel_ != nullptr && *cancel_) throw Error(ErrorKind::interrupted, "interrupted");
}

void SpoolFile::write(std::span<const std::byte> bytes) {
  check_cancel();
  if (bytes.size() > bytes_ - written_) {
    throw Error(ErrorKind::input, cat(packed_path_, ": unpacks to more than the ", bytes_,
                                      " bytes its header asks for; one of the two is damaged"));
  }
  file_->write_at(written_, bytes);
  written_ += bytes.size();
}

std::unique_ptr<InputFile> SpoolFile::finish() {
  if (written_ < bytes_) {
    throw Error(ErrorKind::input, cat(packed_path_, ": unpacks to ", written_, " bytes, and its header asks for ",
                                      bytes_, "; the file is cut or one of the two is damaged"));
  }
  return std::make_unique<InputFile>(cat("/proc/self/fd/", file_->descriptor()), direct_io_,
                                     packed_path_ + " (unpacked)");
}

}  // namespace weir
