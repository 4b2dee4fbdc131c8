#include "ingest/plan/page_buffer.h"

#include <sys/mman.h>

#include <cerrno>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

PageBuffer::PageBuffer(std::size_t size) {
  if (size == 0) return;
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    throw io_error("memory", compose("get ", size, " bytes for reading; lower ", option("memory")), errno);
  }
  bytes_ = {static_cast<std::byte*>(memory), size};
  constexpr std::size_t kLarge = std::size_t{8} << 20U;
  if (size >= kLarge) ::madvise(memory, size, MADV_HUGEPAGE);  // fewer pages are made; where it is refused, small ones
}

PageBuffer::~PageBuffer() {
  if (!bytes_.empty()) ::munmap(bytes_.data(), bytes_.size());
}

PageBuffer::PageBuffer(PageBuffer&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

PageBuffer& PageBuffer::operator=(PageBuffer&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

}  // namespace weir
