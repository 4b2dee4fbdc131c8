// Deflate streams with a gzip or zlib wrapper, unpacked piece by piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ingest/input_file.h"
#include "ingest/source_options.h"

struct z_stream_s;

namespace weir {

/// No deflate stream unpacks to more than this many times its bytes (zlib, "Technical Details").
inline constexpr std::uint64_t kMaxInflation = 1032;

/// Unpacks one stream, whose wrapper tells gzip from zlib; gzip may be several members in a row and end in
/// zero padding. Holds kOutputBytes and zlib's window of 32 KiB. Not thread-safe.
class Inflater {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;
  static constexpr std::size_t kOutputBytes = std::size_t{256} << 10U;

  /// `where` begins the messages: the path, and the place in it.
  explicit Inflater(std::string where);
  ~Inflater();
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Unpacks the next bytes of the stream into `sink`, up to kOutputBytes a call; a sink that has enough
  /// throws. Throws Error(input) with the offset in the stream where it is damaged or goes on after its end.
  void push(std::span<const std::byte> packed, const Sink& sink);
  /// Throws Error(input) where the stream is not at its end.
  void finish() const;

 private:
  bool restart(std::span<const std::byte>& packed);
  [[noreturn]] void damaged(const std::string& what) const;

  std::string where_;
  std::unique_ptr<z_stream_s> stream_;
  std::vector<std::byte> output_;
  std::uint64_t packed_ = 0;    ///< bytes taken so far
  std::uint64_t unpacked_ = 0;  ///< bytes handed out so far
  bool gzip_ = false;
  bool ended_ = false;
};

/// Bytes of a file that are one compressed stream.
struct PackedRange {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;  ///< offset + bytes <= the file's size
};

/// Where what is wanted lies in an unpacked stream.
struct UnpackedRange {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;  ///< > 0
  std::uint64_t end = 0;    ///< of the whole stream, >= offset + bytes
};

/// Unpacks `packed` of `file` once, to its end, in bounded memory, and keeps `wanted` in a spool file. Throws
/// Error(input) where the stream is damaged, cut, or not exactly wanted.end bytes long, and what SpoolFile throws.
std::unique_ptr<InputFile> spool_inflated(InputFile& file, const PackedRange& packed, const UnpackedRange& wanted,
                                          const SourceOptions& options);

}  // namespace weir
