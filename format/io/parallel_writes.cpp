#include "format/io/parallel_writes.h"

#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/vfs.h>

#include <cstring>

namespace weir {

void ParallelWrites::begin(int descriptor, std::uint64_t size) {
  end();
  struct statfs status {};
  if (size == 0 || ::fstatfs(descriptor, &status) != 0 || status.f_type != TMPFS_MAGIC) return;
  void* const mapping = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (mapping != MAP_FAILED) mapping_ = {static_cast<std::byte*>(mapping), size};
}

void ParallelWrites::end() {
  if (!mapping_.empty()) ::munmap(mapping_.data(), mapping_.size());
  mapping_ = {};
}

bool ParallelWrites::copy(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (offset > mapping_.size() || bytes.size() > mapping_.size() - offset) return false;
  std::memcpy(mapping_.data() + offset, bytes.data(), bytes.size());
  constexpr std::size_t kMostResident = std::size_t{4} << 20U;
  if (resident_.fetch_add(bytes.size()) + bytes.size() >= kMostResident) {
    resident_ = 0;
    ::madvise(mapping_.data(), mapping_.size(), MADV_DONTNEED);  // the file keeps them
  }
  return true;
}

}  // namespace weir
