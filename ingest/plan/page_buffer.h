// Page-aligned memory straight from the kernel. It is not zero-filled by hand and goes back to the kernel at once
// when freed. It uses large pages as far as they fill the buffer. In a virtual machine, for instance, pages are slow
// to map, and mapping small pages took a fifth of the time of small conversions.
#pragma once

#include <cstddef>
#include <span>

namespace weir {

/// Owns `size` bytes that are zero until written. A page costs memory only once it is touched.
class PageBuffer {
 public:
  /// Throws Error(io) naming the size if the kernel refuses. `size` may be 0.
  explicit PageBuffer(std::size_t size);
  ~PageBuffer();
  PageBuffer(PageBuffer&& other) noexcept;
  PageBuffer& operator=(PageBuffer&& other) noexcept;

  std::span<std::byte> bytes() const { return bytes_; }
  /// Returns the buffer as floats, without bytes beyond the last whole float.
  std::span<float> floats() const { return {reinterpret_cast<float*>(bytes_.data()), bytes_.size() / sizeof(float)}; }

 private:
  std::span<std::byte> bytes_;
};

}  // namespace weir
