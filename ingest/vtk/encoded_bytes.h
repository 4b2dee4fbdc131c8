// The bytes that VTK XML files keep as base64 text, or as they are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ingest/vtk/file_text.h"

namespace weir {

/// Reads and decodes from a place in a file on. Several base64 texts behind each other, each padded, are one: VTK
/// encodes sizes and data apart, other writers together.
class EncodedBytes {
 public:
  /// `where` begins the messages: path and array.
  EncodedBytes(InputFile& file, std::uint64_t begin, std::uint64_t end, bool base64, std::string where)
      : text_(file, begin, end), base64_(base64), where_(std::move(where)) {}

  /// Fills `into`. Throws Error(input) where the text ends before or has another character than base64's.
  void read(std::span<std::byte> into);

 private:
  bool decode_group();

  FileText text_;
  bool base64_;
  std::string where_;
  std::array<std::byte, 3> group_{};  ///< decoded and not yet handed out: the last group_left_ of group_size_
  std::size_t group_size_ = 0;
  std::size_t group_left_ = 0;
};

}  // namespace weir
