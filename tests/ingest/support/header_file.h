// Writes files of a header and values, for the tests of such formats.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/source/volume_source.h"
#include "tests/ingest/support/scratch.h"

namespace weir {

/// Returns the values as a file of that byte order stores them.
template <typename T>
std::vector<std::byte> stored(const std::vector<T>& values, bool big_endian = false) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  if (big_endian != (std::endian::native == std::endian::big)) {
    for (auto at = bytes.begin(); at != bytes.end(); at += sizeof(T)) std::reverse(at, at + sizeof(T));
  }
  return bytes;
}

inline std::string write_headed(const Scratch& scratch, const std::string& name, std::string_view header,
                                std::span<const std::byte> values = {}) {
  std::vector<std::byte> bytes(header.size() + values.size());
  std::copy_n(reinterpret_cast<const std::byte*>(header.data()), header.size(), bytes.begin());
  std::copy(values.begin(), values.end(), bytes.begin() + static_cast<std::ptrdiff_t>(header.size()));
  return scratch.write(name, bytes);
}

/// Returns `count` values 0, 1, 2, ..., of which the first few are replaced by the ends of T's range and -1.
template <typename T>
std::vector<T> telling_values(std::size_t count) {
  std::vector<T> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(i);
  values[1] = std::numeric_limits<T>::lowest();
  values[2] = std::numeric_limits<T>::max();
  values[3] = static_cast<T>(-1);
  return values;
}

template <typename T>
std::vector<float> as_floats(const std::vector<T>& values) {
  std::vector<float> floats(values.size());
  std::transform(values.begin(), values.end(), floats.begin(), [](T v) { return static_cast<float>(v); });
  return floats;
}

inline std::vector<float> read_volume(VolumeSource& source) {
  std::vector<float> values(static_cast<std::size_t>(source.info().domain().voxels()), -1.0F);
  source.read(source.info().domain(), values);
  return values;
}

}  // namespace weir
