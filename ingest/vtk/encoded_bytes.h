// Reads the bytes that VTK XML files keep as base64 text or as raw bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ingest/vtk/file_text.h"

namespace weir {

/// Reads and decodes a range of a file. Several padded base64 texts, one after the other, count as one: VTK encodes
/// sizes and data separately, other writers encode them together.
class EncodedBytes {
 public:
  /// Messages begin with `where`: path and array.
  EncodedBytes(InputFile& file, std::uint64_t begin, std::uint64_t end, bool base64, std::string where)
      : text_(file, begin, end), base64_(base64), where_(std::move(where)) {}

  /// Fills `into`. Throws Error(input) if the text ends too early or has a character that is not base64.
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
