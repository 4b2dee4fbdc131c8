// A legacy VTK file as its parser reads it: lines, and between them values that
// are bytes or words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace weir {

class VtkLegacyText {
 public:
  /// No line that people or VTK write is longer.
  static constexpr std::size_t kMaxLineBytes = 4096;

  /// `in` stands at the first of `size` bytes and outlives the object.
  VtkLegacyText(std::istream& in, std::uint64_t size, const std::string& path)
      : bytes_(*in.rdbuf()), size_(size), path_(path) {}

  const std::string& path() const { return path_; }
  std::uint64_t position() const { return position_; }  ///< of the next byte

  /// The next line without its end, LF or CRLF; valid until the next call. nullopt at the end of the file.
  std::optional<std::string_view> line();
  /// The first word of the last line; empty where that has none.
  std::string first_word() const;
  /// Skips lines up to an empty one, and that.
  void skip_paragraph();
  void skip_bytes(std::uint64_t count);
  void skip_words(std::uint64_t count);
  /// Skips lines of any length, empty ones too. Throws as skip_words.
  void skip_lines(std::uint64_t count);
  /// Skips binary strings, each behind its length: the first byte's upper two bits say of how many big-endian bytes
  /// that is, 3 of one, 2 of two, 1 of four, 0 of eight, and all other bits are the length (vtkDataWriter::WriteArray).
  /// Throws as skip_words and skip_bytes.
  void skip_strings(std::uint64_t count);
  /// The next bytes. Throws as skip_bytes.
  void read_bytes(std::span<std::byte> into);
  /// The next word, of which kMaxLineBytes are kept. Throws as skip_words.
  std::string word();

  /// Throws Error(input): "PATH: before byte N: WHAT".
  [[noreturn]] void fail(std::string_view what) const;

 private:
  int next();
  std::uint64_t string_length(std::uint64_t index, std::uint64_t count);
  [[noreturn]] void lacks_values(std::uint64_t count, std::uint64_t found) const;
  void require_bytes(std::uint64_t count) const;

  std::streambuf& bytes_;
  std::uint64_t size_;
  const std::string& path_;
  std::uint64_t position_ = 0;
  std::string line_;
};

}  // namespace weir
