// Content digests: xxh3-128 of pieces, combined into one. The digest of a whole
// is the xxh3-128 of its pieces' digests in order (16 bytes each, xxHash's
// canonical big-endian form), so pieces may be hashed in parallel or while
// streaming. Two such digests exist, both written as 32 lower-case hex digits:
//   file    pieces of 16 MiB, the last one shorter
//   source  one piece a leaf, see FORMAT.md, "Digests"
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "format/io/file_system.h"

struct XXH3_state_s;

namespace weir {

/// Bytes of a piece of a file; the last piece may be shorter.
inline constexpr std::uint64_t kDigestPieceBytes = std::uint64_t{16} << 20U;

/// A good size for the scratch memory of piece_digest(): it fits the second-level cache.
inline constexpr std::size_t kDigestScratchBytes = std::size_t{1} << 20U;

/// An xxh3-128 in canonical form.
struct Digest {
  std::array<std::byte, 16> bytes{};

  /// Returns 32 lower-case hex digits.
  std::string hex() const;
  friend constexpr bool operator==(const Digest&, const Digest&) = default;
};

/// Returns the xxh3-128 of one piece.
Digest piece_digest(std::span<const std::byte> piece);
/// Returns the xxh3-128 of the `bytes` bytes of `file` from `offset` on, read through `scratch`, which may have any
/// size.
Digest piece_digest(File& file, std::uint64_t offset, std::uint64_t bytes, std::span<std::byte> scratch);
/// Returns the xxh3-128 of the float32 values of a leaf inside the domain (x fastest), as little-endian bytes.
Digest leaf_digest(std::span<const float> values);

/// Returns the xxh3-64 of `bytes`, with their position `place` in the file as the seed. The sum of these over the
/// pieces of a file does not depend on the order in which they are written, and tells whether all are as they were.
std::uint64_t placed_checksum(std::uint64_t place, std::span<const std::byte> bytes);

/// Combines digests one after the other, in constant memory. Not thread-safe.
class DigestStream {
 public:
  DigestStream();
  ~DigestStream();
  DigestStream(DigestStream&&) noexcept;
  DigestStream& operator=(DigestStream&&) noexcept;

  void update(const Digest& next);
  /// Adds several consecutive digests.
  void update(std::span<const Digest> next);
  /// Returns the digest of everything added so far; more may be added afterwards.
  Digest digest() const;

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

/// Returns what a DigestStream of all `pieces` returns.
Digest combine(std::span<const Digest> pieces);

/// Returns the digest of a whole file; reads its pieces one after the other.
Digest whole_digest(File& file);
/// Returns the digest of a whole file in memory.
Digest whole_digest(std::span<const std::byte> file);

/// Returns the number of pieces of a file of `bytes` bytes.
constexpr std::uint64_t piece_count(std::uint64_t bytes) {
  return bytes / kDigestPieceBytes + (bytes % kDigestPieceBytes != 0 ? 1 : 0);
}
/// Returns piece `i` of a file in memory; i < piece_count(file.size()).
std::span<const std::byte> file_piece(std::span<const std::byte> file, std::uint64_t i);

}  // namespace weir
