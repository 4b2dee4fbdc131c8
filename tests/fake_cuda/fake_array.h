// A 3-D array of the pretended device, in host memory.
#pragma once

#include <cstddef>
#include <cstring>

#include "gpu/math/vector3.h"

namespace weir::test {

/// The texels follow the object in memory, x fastest.
struct FakeArray {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t depth = 0;
  std::size_t texel_bytes = 0;

  std::size_t bytes() const { return width * height * depth * texel_bytes; }
  template <class Texel>
  Texel read(const Int3& at) const {
    Texel texel;
    std::memcpy(&texel, place(at), sizeof texel);
    return texel;
  }
  template <class Texel>
  void write(const Int3& at, Texel texel) {
    std::memcpy(place(at), &texel, sizeof texel);
  }

 private:
  std::byte* place(const Int3& at) const {
    const auto x = static_cast<std::size_t>(at.x), y = static_cast<std::size_t>(at.y),
               z = static_cast<std::size_t>(at.z);
    return reinterpret_cast<std::byte*>(const_cast<FakeArray*>(this) + 1) +
           texel_bytes * (x + width * (y + height * z));
  }
};

/// What a texture or surface object of the pretended device refers to.
struct FakeView {
  FakeArray* array = nullptr;
};

inline FakeArray& array_of(unsigned long long object) { return *reinterpret_cast<FakeView*>(object)->array; }

}  // namespace weir::test
