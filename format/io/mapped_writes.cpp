#include "format/io/mapped_writes.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>

namespace weir {
namespace {

// Has the system map the pages of `bytes`, 16 together if they are cleared. It maps several together only on a read, so
// this function reads one byte per group.
void map_pages(std::span<const std::byte> bytes) {
  constexpr std::size_t kTogether = std::size_t{64} << 10U;
  const std::size_t first = kTogether - reinterpret_cast<std::uintptr_t>(bytes.data()) % kTogether;
  for (std::size_t at = 0; at < bytes.size(); at = at == 0 ? first : at + kTogether) {
    static_cast<void>(*static_cast<const volatile std::byte*>(&bytes[at]));
  }
}

}  // namespace

void clear_reserved_pages(File& file, std::uint64_t bytes, const std::atomic<bool>& stop) {
  if (file.descriptor() < 0) return;
  constexpr std::uint64_t kPiece = std::uint64_t{4} << 20U;
  for (std::uint64_t at = 0; at < bytes && !stop; at += kPiece) {
    // fallocate() of space that is reserved already clears it.
    const auto piece = static_cast<off_t>(std::min(kPiece, bytes - at));
    if (::fallocate(file.descriptor(), 0, static_cast<off_t>(at), piece) != 0) return;
  }
}

std::unique_ptr<MappedWrites> MappedWrites::of(File& file, std::uint64_t bytes) {
  if (file.descriptor() < 0 || bytes == 0) return nullptr;
  void* const mapped = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.descriptor(), 0);
  if (mapped == MAP_FAILED) return nullptr;
  return std::unique_ptr<MappedWrites>(new MappedWrites(file, {static_cast<std::byte*>(mapped), bytes}));
}

MappedWrites::~MappedWrites() { ::munmap(mapped_.data(), mapped_.size()); }

void MappedWrites::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (offset > mapped_.size() || bytes.size() > mapped_.size() - offset) return file_.write_at(offset, bytes);
  const std::span<std::byte> to = mapped_.subspan(offset, bytes.size());
  map_pages(to);
  std::copy(bytes.begin(), bytes.end(), to.begin());
}

}  // namespace weir
