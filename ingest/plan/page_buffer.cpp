#include "ingest/plan/page_buffer.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/process/page_size.h"

namespace weir {
namespace {

constexpr std::size_t kLargePage = std::size_t{2} << 20U;

std::size_t up_to_multiple(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

}  // namespace

PageBuffer::PageBuffer(std::size_t size) {
  if (size == 0) return;
  const std::size_t large = size / kLargePage * kLargePage;
  const std::size_t spare = large > 0 ? kLargePage : 0;
  const std::size_t kept = round_up_to_page(size);
  void* const memory = ::mmap(nullptr, kept + spare, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    throw io_error("memory", compose("get ", size, " bytes for reading; lower ", option("memory")), errno);
  }
  auto* begin = static_cast<std::byte*>(memory);
  if (large > 0) {  // start at a large page, and give back what is mapped before and after
    const std::size_t before =
        up_to_multiple(reinterpret_cast<std::uintptr_t>(begin), kLargePage) - reinterpret_cast<std::uintptr_t>(begin);
    if (before > 0) ::munmap(begin, before);
    begin += before;
    if (before < spare) ::munmap(begin + kept, spare - before);
    ::madvise(begin, large, MADV_HUGEPAGE);  // if the kernel refuses, the pages stay small
  }
  bytes_ = {begin, size};
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
