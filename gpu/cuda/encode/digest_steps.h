// How a warp calculates the digest of a block's 2048 bytes: xxh3-128 without a seed, for an input of this length
// (xxHash's specification, version 0.8: "XXH3 Algorithm Overview"). For host and device.
#pragma once

#include <cstdint>
#include <cstring>

#include "format/base/host_device.h"
#include "gpu/cuda/encode/transform_steps.h"
#include "gpu/cuda/encode/warp_lanes.h"

namespace weir {

/// The specification's default secret, as little-endian words.
struct alignas(16) DigestTables {
  std::uint64_t secret[24] = {
      0xBE4BA423396CFEB8ULL, 0x1CAD21F72C81017CULL, 0xDB979083E96DD4DEULL, 0x1F67B3B7A4A44072ULL, 0x78E5C0CC4EE679CBULL,
      0x2172FFCC7DD05A82ULL, 0x8E2443F7744608B8ULL, 0x4C263A81E69035E0ULL, 0xCB00C391BB52283CULL, 0xA32E531B8B65D088ULL,
      0x4EF90DA297486471ULL, 0xD8ACDEA946EF1938ULL, 0x3F349CE33F76FAA8ULL, 0x1D4F0BC7C7BBDCF9ULL, 0x3159B4CD4BE0518AULL,
      0x647378D9C97E9FC8ULL, 0xC3EBD33483ACC5EAULL, 0xEB6313FAFFA081C5ULL, 0x49DAF0B751DD0D17ULL, 0x9E68D429265516D3ULL,
      0xFCA1477D58BE162BULL, 0xCE31D07AD1B8F88FULL, 0x280416958F3ACB45ULL, 0x7E404BBBCAFBD7AFULL,
  };
};

namespace encode_detail {

inline constexpr unsigned kStripeWords = 8;  // 64-bit words, one for each of the hash's lanes
inline constexpr unsigned kStripes = 16;     // between two scrambles; a block has twice as many stripes
// Byte offsets in the secret.
inline constexpr unsigned kScrambleSecret = 128;
inline constexpr unsigned kLastSecret = 121;
inline constexpr unsigned kLowSecret = 11;
inline constexpr unsigned kHighSecret = 117;

inline constexpr std::uint64_t kPrime32_1 = 0x9E3779B1;
inline constexpr std::uint64_t kPrime32_2 = 0x85EBCA77;
inline constexpr std::uint64_t kPrime32_3 = 0xC2B2AE3D;
inline constexpr std::uint64_t kPrime64_1 = 0x9E3779B185EBCA87ULL;
inline constexpr std::uint64_t kPrime64_2 = 0xC2B2AE3D27D4EB4FULL;
inline constexpr std::uint64_t kPrime64_3 = 0x165667B19E3779F9ULL;
inline constexpr std::uint64_t kPrime64_4 = 0x85EBCA77C2B2AE63ULL;
inline constexpr std::uint64_t kPrime64_5 = 0x27D4EB2F165667C5ULL;
inline constexpr std::uint64_t kBlockBytes = 2048;

// Returns where value i, x fastest, lies on a stage.
WEIR_HOST_DEVICE constexpr unsigned stage_of_x_fastest(unsigned i) {
  return stage_of((i & 7U) << 6U | (i >> 3U & 7U) << 3U | i >> 6U);
}

WEIR_HOST_DEVICE inline std::uint32_t bits_of(float v) {
  std::uint32_t bits;
  memcpy(&bits, &v, sizeof bits);
  return bits;
}

// Returns word `at` of the block's bytes.
WEIR_HOST_DEVICE inline std::uint64_t word_of(const float* stage, unsigned at) {
  return bits_of(stage[stage_of_x_fastest(2 * at)]) | std::uint64_t{bits_of(stage[stage_of_x_fastest(2 * at + 1)])}
                                                          << 32U;
}

WEIR_HOST_DEVICE inline std::uint64_t secret_at(const DigestTables& tables, unsigned byte) {
  const unsigned word = byte / 8;
  const unsigned shift = 8 * (byte % 8);
  return shift == 0 ? tables.secret[word] : tables.secret[word] >> shift | tables.secret[word + 1] << (64 - shift);
}

WEIR_HOST_DEVICE inline std::uint64_t first_of_lane(unsigned lane) {
  switch (lane) {
    case 0:
      return kPrime32_3;
    case 1:
      return kPrime64_1;
    case 2:
      return kPrime64_2;
    case 3:
      return kPrime64_3;
    case 4:
      return kPrime64_4;
    case 5:
      return kPrime32_2;
    case 6:
      return kPrime64_5;
    default:
      return kPrime32_1;
  }
}

WEIR_HOST_DEVICE inline std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) {
#if defined(__CUDA_ARCH__)
  return a * b ^ __umul64hi(a, b);
#else
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(a) * b;
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64U);
#endif
}

WEIR_HOST_DEVICE inline std::uint64_t merged(const DigestTables& tables, const std::uint64_t* lanes, unsigned secret,
                                             std::uint64_t start) {
  for (unsigned i = 0; i < kStripeWords; i += 2) {
    start += folded_product(lanes[i] ^ secret_at(tables, secret + 8 * i),
                            lanes[i + 1] ^ secret_at(tables, secret + 8 * i + 8));
  }
  start ^= start >> 37U;
  start *= 0x165667919E3779F9ULL;
  return start ^ start >> 32U;
}

// Writes the digest to `bytes`: 16 bytes in canonical form. `lanes` is the warp's shared memory.
template <class Warp>
WEIR_HOST_DEVICE void digest_stage(const Warp& warp, const DigestTables& tables, const float* stage,
                                   std::uint64_t (&lanes)[kStripeWords], std::uint8_t* bytes) {
  typename Warp::template Own<std::uint64_t> sum, total;
  for (unsigned half = 0; half < 2; ++half) {
    warp.each([&](unsigned lane) {
      const unsigned j = lane % kGroup;
      std::uint64_t some = 0;
      for (unsigned s = lane / kGroup; s < kStripes; s += kLanes / kGroup) {
        const unsigned secret = half == 1 && s == kStripes - 1 ? kLastSecret : 8 * s;
        const unsigned at = kStripeWords * (kStripes * half + s) + j;
        const std::uint64_t key = word_of(stage, at) ^ secret_at(tables, secret + 8 * j);
        some += word_of(stage, at ^ 1U) + (key & 0xFFFFFFFFU) * (key >> 32U);
      }
      sum(lane) = some;
    });
    warp.add_across_groups(sum);
    warp.each([&](unsigned lane) {
      const unsigned j = lane % kGroup;
      std::uint64_t own = (half == 0 ? first_of_lane(j) : total(lane)) + sum(lane);
      if (half == 0) {
        own ^= own >> 47U;
        own ^= secret_at(tables, kScrambleSecret + 8 * j);
        own *= kPrime32_1;
      }
      total(lane) = own;
      if (lane < kGroup) lanes[j] = own;
    });
  }
  warp.each([&](unsigned lane) {
    if (lane > 1) return;
    const std::uint64_t half = lane == 0 ? merged(tables, lanes, kHighSecret, ~(kBlockBytes * kPrime64_2))
                                         : merged(tables, lanes, kLowSecret, kBlockBytes * kPrime64_1);
    for (unsigned i = 0; i < 8; ++i) bytes[8 * lane + i] = static_cast<std::uint8_t>(half >> (56 - 8 * i));
  });
}

}  // namespace encode_detail
}  // namespace weir
