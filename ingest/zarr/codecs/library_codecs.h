// Decoders of libzstd and libblosc, which a build may be left without (WEIR_ZARR_CODECS).
#pragma once

#include <cstddef>
#include <span>

namespace weir {

inline constexpr std::size_t kMostBloscBlock = std::size_t{4} << 20U;
inline constexpr std::size_t kBloscCopies = 3;
/// That libzstd takes for a decoder.
inline constexpr std::size_t kZstdBytes = std::size_t{192} << 10U;

/// Whether this build has them; else both functions are not to be called.
bool has_library_codecs();

/// Decodes the frames `packed` into the front of `bytes`, returns how many they are, and never writes beyond. Throws
/// Error(input), without a place, where they are damaged or hold more.
std::size_t unpack_zstd(std::span<const std::byte> packed, std::span<std::byte> bytes);
/// The same of a buffer of Blosc 1, whose blocks have at most kMostBloscBlock bytes: the library takes memory for
/// kBloscCopies of one. Larger ones, which nobody gets without asking for them, are refused.
std::size_t unpack_blosc(std::span<const std::byte> packed, std::span<std::byte> bytes);

}  // namespace weir
