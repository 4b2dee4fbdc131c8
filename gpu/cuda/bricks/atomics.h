// Atomic operations on words that the threads of a device, or of the host, share.
#pragma once

#include <atomic>
#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// The atomic_ functions return the previous value.
template <class Word>
WEIR_HOST_DEVICE Word atomic_add(Word* at, Word n) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(at, n);
#else
  return std::atomic_ref<Word>(*at).fetch_add(n);
#endif
}

WEIR_HOST_DEVICE inline std::uint32_t atomic_or(std::uint32_t* at, std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return atomicOr(at, bits);
#else
  return std::atomic_ref<std::uint32_t>(*at).fetch_or(bits);
#endif
}

WEIR_HOST_DEVICE inline std::uint32_t atomic_and(std::uint32_t* at, std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return atomicAnd(at, bits);
#else
  return std::atomic_ref<std::uint32_t>(*at).fetch_and(bits);
#endif
}

WEIR_HOST_DEVICE inline std::uint32_t atomic_max(std::uint32_t* at, std::uint32_t n) {
#if defined(__CUDA_ARCH__)
  return atomicMax(at, n);
#else
  std::atomic_ref<std::uint32_t> word(*at);
  std::uint32_t before = word.load();
  while (before < n && !word.compare_exchange_weak(before, n)) {
  }
  return before;
#endif
}

/// Reads the word past a device's first-level cache, so that other threads' recent changes are seen.
WEIR_HOST_DEVICE inline std::uint32_t load_fresh(const std::uint32_t* at) {
#if defined(__CUDA_ARCH__)
  return __ldcg(at);
#else
  return std::atomic_ref<std::uint32_t>(*const_cast<std::uint32_t*>(at)).load(std::memory_order_relaxed);
#endif
}

/// For words that all threads set to the same value.
WEIR_HOST_DEVICE inline void store(std::uint32_t* at, std::uint32_t n) {
#if defined(__CUDA_ARCH__)
  *at = n;
#else
  std::atomic_ref<std::uint32_t>(*at).store(n, std::memory_order_relaxed);
#endif
}

/// Writes `n` if the word is `expected`.
WEIR_HOST_DEVICE inline std::uint64_t atomic_replace(std::uint64_t* at, std::uint64_t expected, std::uint64_t n) {
#if defined(__CUDA_ARCH__)
  using Word = unsigned long long;
  return atomicCAS(reinterpret_cast<Word*>(at), static_cast<Word>(expected), static_cast<Word>(n));
#else
  std::atomic_ref<std::uint64_t>(*at).compare_exchange_strong(expected, n);
  return expected;
#endif
}

}  // namespace weir
