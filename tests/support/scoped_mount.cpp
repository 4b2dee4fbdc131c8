#include "tests/support/scoped_mount.h"

#include <sys/mount.h>

#include <cerrno>
#include <system_error>

namespace weir {

ScopedMount::ScopedMount(const std::filesystem::path& directory, std::uint64_t bytes) : directory_(directory.string()) {
  const std::string options = "size=" + std::to_string(bytes);
  if (mount("tmpfs", directory_.c_str(), "tmpfs", 0, options.c_str()) != 0)
    refused_ = "cannot mount over " + directory_ + ": " + std::generic_category().message(errno);
}

ScopedMount::~ScopedMount() {
  if (refused_.empty()) umount2(directory_.c_str(), MNT_DETACH);
}

void ScopedMount::make_read_only() {
  if (mount(nullptr, directory_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) != 0)
    throw std::system_error(errno, std::generic_category(), "remount " + directory_ + " read-only");
}

}  // namespace weir
