#include "format/io/mapped_writes.h"

#include <sys/mman.h>

#include <algorithm>

namespace weir {

std::unique_ptr<MappedWrites> MappedWrites::of(File& file, std::uint64_t bytes) {
  if (file.descriptor() < 0 || bytes == 0) return nullptr;
  void* const mapped = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.descriptor(), 0);
  if (mapped == MAP_FAILED) return nullptr;
  return std::unique_ptr<MappedWrites>(new MappedWrites(file, {static_cast<std::byte*>(mapped), bytes}));
}

MappedWrites::~MappedWrites() { ::munmap(mapped_.data(), mapped_.size()); }

void MappedWrites::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (offset > mapped_.size() || bytes.size() > mapped_.size() - offset) return file_.write_at(offset, bytes);
  std::copy(bytes.begin(), bytes.end(), mapped_.subspan(offset).begin());
}

}  // namespace weir
