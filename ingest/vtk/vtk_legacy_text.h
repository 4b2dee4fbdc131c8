// A legacy VTK file as its parser reads it: lines, and values between them as bytes or words.
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
  /// The longest line. Neither people nor VTK write longer ones.
  static constexpr std::size_t kMaxLineBytes = 4096;

  /// `in` stands at the first of `size` bytes and outlives the object.
  VtkLegacyText(std::istream& in, std::uint64_t size, const std::string& path)
      : bytes_(*in.rdbuf()), size_(size), path_(path) {}

  const std::string& path() const { return path_; }
  std::uint64_t position() const { return position_; }  ///< of the next byte

  /// Returns the next line without its end, LF or CRLF; valid until the next call. nullopt at the end of the file.
  std::optional<std::string_view> line();
  /// Returns the first word of the last line; empty if the line has none.
  std::string first_word() const;
  /// Skips lines up to and including an empty line.
  void skip_paragraph();
  void skip_bytes(std::uint64_t count);
  void skip_words(std::uint64_t count);
  /// Skips lines of any length, empty lines too. Throws like skip_words().
  void skip_lines(std::uint64_t count);
  /// Skips binary strings, each after its length. The first byte's upper two bits give the number of big-endian bytes
  /// of the length: 3 for one byte, 2 for two, 1 for four, 0 for eight. All other bits are the length
  /// (vtkDataWriter::WriteArray). Throws like skip_words() and skip_bytes().
  void skip_strings(std::uint64_t count);
  /// Reads the next bytes. Throws like skip_bytes().
  void read_bytes(std::span<std::byte> into);
  /// Returns the next word, at most its first kMaxLineBytes. Throws like skip_words().
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
