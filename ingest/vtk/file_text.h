// Reads a range of a file's bytes in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ingest/files/input_file.h"
#include "ingest/plan/page_buffer.h"

namespace weir {

/// Holds a buffer of kPieceBytes (ingest/plan/staging.h). Not thread-safe.
class FileText {
 public:
  /// Bytes [begin, end) of `file`, which outlives the object.
  FileText(InputFile& file, std::uint64_t begin, std::uint64_t end);

  /// Returns the next bytes, valid until the next call; empty at the end. Throws the errors of InputFile's reads.
  std::string_view next_piece();
  /// Returns the next byte, or -1 at the end.
  int next() {
    if (at_ == piece_.size()) {
      piece_ = next_piece();
      at_ = 0;
      if (piece_.empty()) return -1;
    }
    return static_cast<unsigned char>(piece_[at_++]);
  }

 private:
  InputFile& file_;
  std::uint64_t position_;
  std::uint64_t end_;
  PageBuffer buffer_;
  std::string_view piece_;
  std::size_t at_ = 0;
};

}  // namespace weir
