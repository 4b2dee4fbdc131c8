// A warp that works on one block: what its lanes do between two synchronisation points, and what they exchange there.
// On the host one thread runs the lanes in turn. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir::encode_detail {

inline constexpr unsigned kLanes = 32;

/// Lanes in groups of eight, as the CPU has them in a vector.
inline constexpr unsigned kGroup = 8;

/// A T of each lane.
template <class T>
class HostOwn {
 public:
  T& operator()(unsigned lane) { return of_[lane]; }

 private:
  T of_[kLanes] = {};
};

class HostWarp {
 public:
  template <class T>
  using Own = HostOwn<T>;

  template <class Work>
  void each(const Work& work) const {
    for (unsigned lane = 0; lane < kLanes; ++lane) work(lane);
  }
  /// Combines the values of all lanes by `two(a, b)`, in any order.
  template <class T, class Two>
  T of_all(Own<T>& own, const Two& two) const {
    T all = own(0);
    for (unsigned lane = 1; lane < kLanes; ++lane) all = two(all, own(lane));
    return all;
  }
  /// Combines the values of each group in the same way.
  template <class T, class Two>
  void of_groups(Own<T>& own, const Two& two) const {
    for (unsigned group = 0; group < kLanes; group += kGroup) {
      T all = own(group);
      for (unsigned lane = 1; lane < kGroup; ++lane) all = two(all, own(group + lane));
      for (unsigned lane = 0; lane < kGroup; ++lane) own(group + lane) = all;
    }
  }
  /// Computes 0.0 + the first + the second ... of each group, in this order.
  template <class T>
  void add_in_order(Own<T>& own, Own<double>& sums) const {
    for (unsigned group = 0; group < kLanes; group += kGroup) {
      double sum = 0;
      for (unsigned lane = 0; lane < kGroup; ++lane) sum += static_cast<double>(own(group + lane));
      for (unsigned lane = 0; lane < kGroup; ++lane) sums(group + lane) = sum;
    }
  }
  /// Sums over the lanes that have the same place in each group.
  void add_across_groups(Own<std::uint64_t>& own) const {
    for (unsigned at = 0; at < kGroup; ++at) {
      std::uint64_t sum = 0;
      for (unsigned lane = at; lane < kLanes; lane += kGroup) sum += own(lane);
      for (unsigned lane = at; lane < kLanes; lane += kGroup) own(lane) = sum;
    }
  }
  /// Returns the sum over the first 16 lanes: adds to each lane the lane 8 further on, then 4, 2 and 1.
  double add_pairwise(Own<double>& own) const {
    for (unsigned away = kLanes / 4; away > 0; away /= 2) {
      for (unsigned lane = 0; lane < away; ++lane) own(lane) += own(lane + away);
    }
    return own(0);
  }
  /// Replaces each lane's number by the sum of the lanes before it. Returns the sum of all lanes.
  std::uint32_t add_before(Own<std::uint32_t>& own) const {
    std::uint32_t sum = 0;
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t one = own(lane);
      own(lane) = sum;
      sum += one;
    }
    return sum;
  }
  /// Sets bits in a word that several lanes write.
  void set_bits(std::uint32_t* word, std::uint32_t bits) const { *word |= bits; }
};

#if defined(__CUDACC__)

template <class T>
class DeviceOwn {
 public:
  __device__ T& operator()(unsigned) { return own_; }

 private:
  T own_ = {};
};

class DeviceWarp {
 public:
  template <class T>
  using Own = DeviceOwn<T>;

  __device__ static unsigned lane() { return threadIdx.x % kLanes; }

  template <class Work>
  __device__ void each(const Work& work) const {
    work(lane());
    __syncwarp();
  }
  template <class T, class Two>
  __device__ T of_all(Own<T>& own, const Two& two) const {
    T all = own(0);
    for (unsigned away = kLanes / 2; away > 0; away /= 2) all = two(all, __shfl_xor_sync(~0U, all, away));
    return __shfl_sync(~0U, all,
                       0);  // lanes may find different NaNs or zeros; all must go on with one
  }
  template <class T, class Two>
  __device__ void of_groups(Own<T>& own, const Two& two) const {
    for (unsigned away = kGroup / 2; away > 0; away /= 2) own(0) = two(own(0), __shfl_xor_sync(~0U, own(0), away));
  }
  template <class T>
  __device__ void add_in_order(Own<T>& own, Own<double>& sums) const {
    double sum = 0;
    WEIR_UNROLL
    for (unsigned from = 0; from < kGroup; ++from) sum += static_cast<double>(__shfl_sync(~0U, own(0), from, kGroup));
    sums(0) = sum;
  }
  __device__ void add_across_groups(Own<std::uint64_t>& own) const {
    for (unsigned away = kGroup; away < kLanes; away *= 2) own(0) += __shfl_xor_sync(~0U, own(0), away);
  }
  __device__ double add_pairwise(Own<double>& own) const {
    double sum = own(0);
    for (unsigned away = kLanes / 4; away > 0; away /= 2) sum += __shfl_xor_sync(~0U, sum, away);
    return __shfl_sync(~0U, sum, 0);
  }
  __device__ std::uint32_t add_before(Own<std::uint32_t>& own) const {
    std::uint32_t sum = own(0);
    WEIR_UNROLL
    for (unsigned away = 1; away < kLanes; away *= 2) {
      const std::uint32_t before = __shfl_up_sync(~0U, sum, away);
      if (lane() >= away) sum += before;
    }
    own(0) = sum - own(0);
    return __shfl_sync(~0U, sum, kLanes - 1);
  }
  __device__ void set_bits(std::uint32_t* word, std::uint32_t bits) const { atomicOr(word, bits); }
};

#endif

}  // namespace weir::encode_detail
