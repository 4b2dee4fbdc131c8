#include "format/io/digest.h"

#define XXH_STATIC_LINKING_ONLY  // a state on the stack
#include <xxhash.h>
#if defined(__x86_64__) && __has_include(<xxh_x86dispatch.h>)
#include <xxh_x86dispatch.h>  // the widest vectors the machine has
#endif

#include <algorithm>
#include <bit>
#include <new>
#include <vector>

namespace weir {
namespace {

static_assert(std::endian::native == std::endian::little, "leaf digests are of little-endian values");
static_assert(sizeof(Digest) == sizeof(XXH128_canonical_t), "digests are hashed as they lie in memory");

Digest canonical(const XXH128_hash_t& hash) {
  XXH128_canonical_t form;
  XXH128_canonicalFromHash(&form, hash);
  return std::bit_cast<Digest>(form);
}

}  // namespace

std::string Digest::hex() const {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const std::byte byte : bytes) {
    text += kDigits[static_cast<unsigned>(byte) >> 4U];
    text += kDigits[static_cast<unsigned>(byte) & 15U];
  }
  return text;
}

Digest piece_digest(std::span<const std::byte> piece) { return canonical(XXH3_128bits(piece.data(), piece.size())); }

Digest piece_digest(File& file, std::uint64_t offset, std::uint64_t bytes, std::span<std::byte> scratch) {
  XXH3_state_t state;
  XXH3_128bits_reset(&state);
  while (bytes > 0) {
    const auto part = scratch.first(std::min<std::uint64_t>(scratch.size(), bytes));
    file.read_at(offset, part);
    XXH3_128bits_update(&state, part.data(), part.size());
    offset += part.size();
    bytes -= part.size();
  }
  return canonical(XXH3_128bits_digest(&state));
}

Digest leaf_digest(std::span<const float> values) { return piece_digest(std::as_bytes(values)); }

std::uint64_t placed_checksum(std::uint64_t place, std::span<const std::byte> bytes) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), place);
}

void DigestStream::Free::operator()(XXH3_state_s* state) const { XXH3_freeState(state); }

DigestStream::DigestStream() : state_(XXH3_createState()) {
  if (state_ == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state_.get());
}

DigestStream::~DigestStream() = default;
DigestStream::DigestStream(DigestStream&&) noexcept = default;
DigestStream& DigestStream::operator=(DigestStream&&) noexcept = default;

void DigestStream::update(const Digest& next) { update(std::span(&next, 1)); }

void DigestStream::update(std::span<const Digest> next) {
  XXH3_128bits_update(state_.get(), next.data(), next.size_bytes());
}

Digest DigestStream::digest() const { return canonical(XXH3_128bits_digest(state_.get())); }

Digest combine(std::span<const Digest> pieces) { return piece_digest(std::as_bytes(pieces)); }

std::span<const std::byte> file_piece(std::span<const std::byte> file, std::uint64_t i) {
  const std::uint64_t begin = i * kDigestPieceBytes;
  return file.subspan(begin, std::min<std::uint64_t>(kDigestPieceBytes, file.size() - begin));
}

Digest whole_digest(File& file) {
  const std::uint64_t bytes = file.size();
  std::vector<std::byte> scratch(kDigestScratchBytes);
  DigestStream pieces;
  for (std::uint64_t offset = 0; offset < bytes; offset += kDigestPieceBytes) {
    pieces.update(piece_digest(file, offset, std::min(kDigestPieceBytes, bytes - offset), scratch));
  }
  return pieces.digest();
}

Digest whole_digest(std::span<const std::byte> file) {
  DigestStream pieces;
  for (std::uint64_t i = 0; i < piece_count(file.size()); ++i) pieces.update(piece_digest(file_piece(file, i)));
  return pieces.digest();
}

}  // namespace weir
