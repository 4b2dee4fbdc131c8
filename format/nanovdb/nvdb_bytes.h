// A part of a file under validation: loads by offset, and gives all messages about its faults one form. Only the nvdb_*
// readers and the readers of packed data use it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/leaf/leaf_decode.h"

namespace weir {

static_assert(std::endian::native == std::endian::little, "fields are loaded as they stand in the file");

class NvdbBytes {
 public:
  /// `bytes` begins at `file_offset` of the file `path`; both must outlive the object.
  NvdbBytes(std::span<const std::byte> bytes, std::uint64_t file_offset, const std::string& path)
      : bytes_(bytes), file_offset_(file_offset), path_(&path) {}

  std::uint64_t size() const { return bytes_.size(); }
  const std::byte* at(std::uint64_t offset) const { return bytes_.data() + offset; }
  const std::string& path() const { return *path_; }

  /// Returns the little-endian T at `offset`; the caller has checked that offset + sizeof(T) <= size().
  template <typename T>
  T get(std::uint64_t offset) const {
    return load<T>(at(offset));
  }
  /// Returns whether [offset, offset + bytes) lies inside; never wraps.
  bool holds(std::uint64_t offset, std::uint64_t bytes) const {
    return offset <= bytes_.size() && bytes <= bytes_.size() - offset;
  }

  /// Throws Error(input): "PATH: at byte N: WHAT...", N counted from the file's start.
  template <typename... Args>
  [[noreturn]] void fail(std::uint64_t offset, const Args&... what) const {
    throw Error(ErrorKind::input, cat(*path_, ": at byte ", file_offset_ + offset, ": ", what...));
  }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t file_offset_;
  const std::string* path_;
};

}  // namespace weir
