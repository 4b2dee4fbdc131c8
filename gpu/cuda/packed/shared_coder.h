// The entropy coder's tables in the shared memory of a group of threads. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_scan.h"
#include "format/packed/coefficient_decoder.h"
#include "gpu/cuda/packed/scan_steps.h"
#include "gpu/cuda/packed/stream_queue.h"

namespace weir::decode_detail {

inline constexpr unsigned kBucketShift = kFrequencyBits - 8;
static_assert(kSymbolBuckets << kBucketShift == 1U << kFrequencyBits);
// Contexts of the residuals of lattice blocks, counted in buckets.
inline constexpr unsigned kResidualContexts = kPackedLevels * kPackedBands * kSymbolBuckets;

// The tables of the entropy coder, in shared memory or in the layout that is copied there.
class SharedTables {
 public:
  static constexpr unsigned kSymbolBytes = kPackedTables * kPackedSymbols * 4;
  static constexpr unsigned kBucketBytes = kPackedTables * kSymbolBuckets;
  static constexpr unsigned kLevelBytes = (kLevelSums * 2 + 15) / 16 * 16;
  static constexpr unsigned kBytes = kSymbolBytes + kBucketBytes + kLevelBytes;
  static_assert(kBytes % 16 == 0);

  WEIR_HOST_DEVICE explicit SharedTables(unsigned char* shared)
      : symbols_(shared), buckets_(shared + kSymbolBytes), levels_(shared + kSymbolBytes + kBucketBytes) {}

  /// Makes the tables.
  template <class Thread>
  WEIR_HOST_DEVICE void fill(const Thread& thread, const BlockScan& scan, const std::uint16_t* tables) {
    for (unsigned i = thread.index(); i < kPackedTables * kPackedSymbols; i += thread.count()) {
      const std::uint32_t high = i % kPackedSymbols + 1 < kPackedSymbols ? tables[i + 1] : 1U << kFrequencyBits;
      reinterpret_cast<std::uint32_t*>(symbols_)[i] = tables[i] | (high - tables[i]) << 16U;
    }
    for (unsigned i = thread.index(); i < kPackedTables * kSymbolBuckets; i += thread.count()) {
      buckets_[i] = bucket(tables + i / kSymbolBuckets * kPackedSymbols, (i % kSymbolBuckets) << kBucketShift);
    }
    for (unsigned t = thread.index(); t < kLevelBytes / 2;
         t += thread.count()) {  // load() copies the bytes behind the levels, too
      const unsigned level = t < kLevelSums ? scan.level[t] * kSymbolBuckets | extra_bits(t) : 0;
      reinterpret_cast<std::uint16_t*>(levels_)[t] = static_cast<std::uint16_t>(level);
    }
  }

  /// Copies the tables.
  template <class Thread>
  WEIR_HOST_DEVICE void load(const Thread& thread, const unsigned char* from) {
    for (unsigned i = thread.index(); i < kBytes / sizeof(Quad); i += thread.count()) {
      reinterpret_cast<Quad*>(symbols_)[i] = reinterpret_cast<const Quad*>(from)[i];
    }
  }

  /// Returns the level of neighbours whose sum is `t`, times kSymbolBuckets | extra_bits(t). The extra bits are right
  /// only if `t` is below kLevelSums.
  WEIR_HOST_DEVICE std::uint32_t level(std::uint32_t t) const {
    return reinterpret_cast<const std::uint16_t*>(levels_)[t < kLevelSums ? t : kLevelSums - 1];
  }

  /// Decodes a symbol. `context` is counted in buckets.
  WEIR_HOST_DEVICE unsigned symbol(std::uint32_t& x, std::uint32_t context, StreamQueue& words) const {
    const std::uint32_t slot = x & ((1U << kFrequencyBits) - 1U);
    const std::uint32_t bucket = buckets_[context + (slot >> kBucketShift)];
    unsigned found = (bucket >> 4U) - ((x & 15U) < (bucket & 15U) ? 1U : 0U);
    const unsigned char* symbols = symbols_ + (context >> 2U);
    std::uint32_t symbol = *reinterpret_cast<const std::uint32_t*>(symbols + 4 * found);
    std::uint32_t above = slot - (symbol & 0xFFFFU);
    if (above >= symbol >> 16U) [[unlikely]] {
      WEIR_NO_UNROLL
      do {
        symbol = *reinterpret_cast<const std::uint32_t*>(symbols + 4 * ++found);
        above = slot - (symbol & 0xFFFFU);
      } while (above >= symbol >> 16U);
    }
    x = (symbol >> 16U) * (x >> kFrequencyBits) + above;
    words.renormalise(x);
    return found;
  }

 private:
  static_assert(kSymbolBuckets == 4 * kPackedSymbols * 4);

  // If a symbol begins inside the bucket, returns that symbol << 4 | the number of slots before it. Otherwise returns
  // the bucket's symbol << 4.
  WEIR_HOST_DEVICE static unsigned char bucket(const std::uint16_t* table, std::uint32_t first) {
    unsigned found = 0;
    for (unsigned j = 1; j < kPackedSymbols; ++j) found += table[j] <= first ? 1U : 0U;
    if (found + 1 < kPackedSymbols && table[found + 1] < first + (1U << kBucketShift)) {
      return static_cast<unsigned char>((found + 1) << 4U | (table[found + 1] - first));
    }
    return static_cast<unsigned char>(found << 4U);
  }

  unsigned char* symbols_;
  unsigned char* buckets_;
  unsigned char* levels_;
};

}  // namespace weir::decode_detail
