#include "format/output/written_volume.h"

#include <fcntl.h>

#include <cerrno>
#include <utility>

#include "format/base/error.h"

namespace weir {
namespace {

FileMapping mapping_of(const File& file) {
  if (file.descriptor() < 0) return {file.path(), ".nvdb"};
  Descriptor own(::fcntl(file.descriptor(), F_DUPFD_CLOEXEC, 0));
  if (!own) throw io_error(file.path(), "open once more", errno);
  return {std::move(own), file.path(), ".nvdb"};
}

}  // namespace

// A file that a reader calls bad means here that the device does not hold what was written.
WrittenVolume::WrittenVolume(const File& file) {
  try {
    if (const auto bytes = file.memory(); !bytes.empty()) {
      held_ = NvdbGrid::open(bytes, file.path());
    } else {
      mapped_.emplace(mapping_of(file));
    }
  } catch (const Error& error) {
    throw Error(ErrorKind::io, compose(error.message(), "; it was written just now, check the disk"),
                error.system_failure());
  }
}

void WrittenVolume::release_pages() const {
  if (mapped_) mapped_->mapping().release_pages();
}

}  // namespace weir
