// Unpacks deflate streams with a gzip or zlib wrapper piece by piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct z_stream_s;

namespace weir {

/// Unpacks one stream and detects its wrapper, gzip or zlib. A gzip stream may be several members in a row and end in
/// zero padding. Holds kOutputBytes and zlib's window of 32 KiB. Not thread-safe.
class StreamInflater {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;
  static constexpr std::size_t kOutputBytes = std::size_t{256} << 10U;

  /// Messages begin with `where`: the path, and the place in the file.
  explicit StreamInflater(std::string where);
  ~StreamInflater();
  StreamInflater(const StreamInflater&) = delete;
  StreamInflater& operator=(const StreamInflater&) = delete;

  /// Unpacks the next bytes of the stream into `sink`, up to kOutputBytes a call. A sink may throw once it has
  /// enough. Throws Error(input) with the offset in the stream if it is damaged or continues after its end.
  void push(std::span<const std::byte> packed, const Sink& sink);
  /// Throws Error(input) if the stream is not at its end.
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

}  // namespace weir
