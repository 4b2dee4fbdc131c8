// The decoders of libzstd and libblosc. A build without WEIR_ZARR_CODECS leaves them out.
#pragma once

#include <cstddef>
#include <span>

namespace weir {

inline constexpr std::size_t kMostBloscBlock = std::size_t{4} << 20U;
inline constexpr std::size_t kBloscCopies = 3;
/// Bytes that libzstd allocates for a decoder.
inline constexpr std::size_t kZstdBytes = std::size_t{192} << 10U;

/// Returns whether this build has the decoders. If not, unpack_zstd and unpack_blosc must not be called.
bool has_library_codecs();

/// Decodes the frames `packed` into the front of `bytes` and returns the number of decoded bytes. Never writes beyond
/// `bytes`. Throws Error(input), with no place in its message, if the frames are damaged or hold more bytes.
std::size_t unpack_zstd(std::span<const std::byte> packed, std::span<std::byte> bytes);
/// Does the same for a buffer of Blosc 1. Its blocks may have at most kMostBloscBlock bytes, because the library
/// allocates kBloscCopies times a block. Larger blocks, which Blosc makes only on request, are refused.
std::size_t unpack_blosc(std::span<const std::byte> packed, std::span<std::byte> bytes);

}  // namespace weir
