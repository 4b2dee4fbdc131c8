// An input file as a standard stream, for libraries and parsers that read one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <streambuf>
#include <vector>

#include "ingest/files/input_file.h"

namespace weir {

/// Reads through the page cache and leaves the pages there, because these files are read more than once. Seeking
/// within the buffer costs nothing.
class FileStreambuf final : public std::streambuf {
 public:
  static constexpr std::size_t kBufferBytes = std::size_t{256} << 10U;

  explicit FileStreambuf(InputFile& file) : file_(file), buffer_(kBufferBytes) {}

 protected:
  int_type underflow() override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override;
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override;

 private:
  InputFile& file_;
  std::vector<char> buffer_;
  std::uint64_t begin_ = 0;  ///< offset of the buffer's bytes in the file
};

/// `file` must outlive the stream. Reading past the end throws std::ios_base::failure. A failing device throws what
/// InputFile throws.
class FileStream final : public std::istream {
 public:
  explicit FileStream(InputFile& file) : std::istream(nullptr), buffer_(file) {
    rdbuf(&buffer_);
    exceptions(badbit | failbit | eofbit);
  }

 private:
  FileStreambuf buffer_;
};

}  // namespace weir
