// An output file as a std::ostream, written in order from an offset on, with a digest of the written bytes. For
// libraries and writers that only know std::ostream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <streambuf>
#include <vector>

#include "format/io/digest.h"
#include "format/io/file_system.h"

namespace weir {

class FileSinkbuf final : public std::streambuf {
 public:
  static constexpr std::size_t kBufferBytes = std::size_t{4} << 20U;

  FileSinkbuf(File& file, std::uint64_t offset) : file_(file), flushed_(offset) { buffer_.reserve(kBufferBytes); }

  std::uint64_t position() const { return flushed_ + buffer_.size(); }
  void flush();
  /// Returns the digest of all flushed bytes, combined from pieces of kBufferBytes.
  Digest digest() const { return digest_.digest(); }

 protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize count) override;

 private:
  File& file_;
  std::uint64_t flushed_;  ///< offset in the file of the buffer's first byte
  std::vector<char> buffer_;
  DigestStream digest_;
};

/// `file` must outlive the stream. Throws what File throws.
class FileSink final : public std::ostream {
 public:
  FileSink(File& file, std::uint64_t offset) : std::ostream(nullptr), buffer_(file, offset) {
    rdbuf(&buffer_);
    exceptions(badbit | failbit);
  }

  /// Returns the offset in the file of the next byte to be written.
  std::uint64_t position() const { return buffer_.position(); }
  /// Writes the buffered rest and returns the digest of everything.
  Digest finish() {
    buffer_.flush();
    return buffer_.digest();
  }

 private:
  FileSinkbuf buffer_;
};

}  // namespace weir
