// Page-aligned memory straight from the kernel: not zero-filled by hand, given
// back to the kernel at once when freed. Huge pages are not asked for: the
// compaction they can cost took up to ten times as long as the faults they save.
#pragma once

#include <cstddef>
#include <span>

namespace weir {

/// Owns `size` bytes, zero until written; pages cost memory only once touched.
class PageBuffer {
 public:
  /// Throws Error(io) naming the size where the kernel refuses. Zero bytes are allowed.
  explicit PageBuffer(std::size_t size);
  ~PageBuffer();
  PageBuffer(PageBuffer&& other) noexcept;
  PageBuffer& operator=(PageBuffer&& other) noexcept;

  std::span<std::byte> bytes() const { return bytes_; }
  /// The buffer as floats, whole ones only.
  std::span<float> floats() const { return {reinterpret_cast<float*>(bytes_.data()), bytes_.size() / sizeof(float)}; }

 private:
  std::span<std::byte> bytes_;
};

}  // namespace weir
