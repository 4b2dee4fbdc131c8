// Builds NIfTI headers by hand, in either version and byte order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// A header of 4 x 3 x 2 uint8 values and nothing else. Fields are set by their byte offsets in nifti1.h and nifti2.h.
class NiftiBytes {
 public:
  explicit NiftiBytes(int version, bool big_endian = false)
      : bytes_(version == 1 ? 352 : 544, '\0'), big_endian_(big_endian) {
    if (version == 1) {
      set<std::int32_t>(0, 348);
      for (std::size_t i = 0; i < 4; ++i) set(40 + 2 * i, static_cast<std::int16_t>(i == 0 ? 3 : 5 - i));
      set<std::int16_t>(70, 2);
      set<float>(108, 352);
      bytes_.replace(344, 4, std::string_view("n+1\0", 4));
    } else {
      set<std::int32_t>(0, 540);
      for (std::size_t i = 0; i < 4; ++i) set(16 + 8 * i, static_cast<std::int64_t>(i == 0 ? 3 : 5 - i));
      set<std::int16_t>(12, 2);
      set<std::int64_t>(168, 544);
      bytes_.replace(4, 8, std::string_view("n+2\0\r\n\032\n", 8));
    }
  }

  template <typename T>
  NiftiBytes& set(std::size_t at, T value) {
    std::string stored(sizeof value, '\0');
    std::memcpy(stored.data(), &value, sizeof value);
    if (big_endian_ != (std::endian::native == std::endian::big)) std::reverse(stored.begin(), stored.end());
    bytes_.replace(at, stored.size(), stored);
    return *this;
  }
  /// Sets values of one type from `at` on.
  template <typename T>
  NiftiBytes& set_all(std::size_t at, const std::vector<T>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) set(at + i * sizeof(T), values[i]);
    return *this;
  }
  NiftiBytes& set_text(std::size_t at, std::string_view text) {
    bytes_.replace(at, text.size(), text);
    return *this;
  }

  /// Returns the header and its four bytes of extension flags.
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  bool big_endian_;
};

}  // namespace weir
