// Page-aligned memory straight from the kernel: not zero-filled by hand, given back to the kernel at once when freed.
// It is of large pages as far as they fill it: where pages are slow to map, as in a virtual machine, small ones took a
// fifth of the time of small conversions.
#pragma once

#include <cstddef>
#include <span>

namespace weir {

/// Owns `size` bytes, zero until written. Pages cost memory only once touched.
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
