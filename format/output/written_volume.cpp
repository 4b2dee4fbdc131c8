#include "format/output/written_volume.h"

#include "format/base/error.h"

namespace weir {

// What a reader calls a bad file is here a device that does not hold what was written.
WrittenVolume::WrittenVolume(const File& file) {
  try {
    if (const auto bytes = file.memory(); !bytes.empty()) {
      held_ = NvdbGrid::open(bytes, file.path());
    } else {
      mapped_.emplace(file.path());
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
