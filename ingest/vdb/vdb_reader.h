// Reads the little-endian fields of a .vdb file in order, never beyond its end, and words the errors. Only the vdb_*
// parsers use it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

static_assert(std::endian::native == std::endian::little, "fields are loaded as they stand in the file");

class VdbReader {
 public:
  /// The longest name or word of a header. People write no longer ones.
  static constexpr std::uint32_t kMaxTextBytes = 4096;

  /// `in` stands at the first of `size` bytes and, like `path`, outlives the object.
  VdbReader(std::istream& in, std::uint64_t size, const std::string& path) : in_(in), size_(size), path_(path) {}

  const std::string& path() const { return path_; }
  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return size_ - position_; }

  void seek(std::uint64_t position) {
    if (position > size_) fail("the file of ", size_, " bytes is to go on at byte ", position, "; is it complete?");
    in_.seekg(static_cast<std::streamoff>(position));
    position_ = position;
  }
  void skip(std::uint64_t bytes) {
    need(bytes);
    if (bytes > 0) seek(position_ + bytes);
  }
  void read(void* into, std::size_t bytes) {
    need(bytes);
    in_.read(static_cast<char*>(into), static_cast<std::streamsize>(bytes));
    position_ += bytes;
  }
  template <typename T>
  T get() {
    T value;
    read(&value, sizeof value);
    return value;
  }
  /// Reads a text: four bytes of length, then the characters.
  std::string text() {
    const auto bytes = get<std::uint32_t>();
    if (bytes > kMaxTextBytes) fail("a name of ", bytes, " bytes; the file is damaged");
    std::string value(bytes, '\0');
    if (bytes > 0) read(value.data(), bytes);
    return value;
  }

  /// Throws Error(input): "PATH: at byte N: WHAT...".
  template <typename... Args>
  [[noreturn]] void fail(const Args&... what) const {
    throw Error(ErrorKind::input, cat(path_, ": at byte ", position_, ": ", what...));
  }

 private:
  void need(std::uint64_t bytes) const {
    if (bytes > left()) fail(bytes, " bytes belong there, and the file ends after ", left(), "; is it complete?");
  }

  std::istream& in_;
  std::uint64_t size_;
  const std::string& path_;
  std::uint64_t position_ = 0;
};

}  // namespace weir
