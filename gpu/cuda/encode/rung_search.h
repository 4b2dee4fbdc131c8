// How far the device looks at the rungs of a block if it knows the keys between which the cut lies: as far as the
// search of compressor/packed/ladder_window.h comes, or a little further. Only for a block whose voxels all lie in
// the volume: for others the search uses the error of the voxels inside, which the device does not know. Only the
// time depends on this: if the search comes to a rung that was not looked at, the host takes the block. For host and
// device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_coder.h"
#include "format/packed/stream_length.h"

namespace weir::encode_detail {

// The known facts about a rung: its bytes, and the squared error that it leaves.
struct KnownRung {
  enum class State : std::uint8_t { not_looked_at, none, there };
  State state = State::not_looked_at;
  double bytes = 0;
  double squared_error = 0;

  WEIR_HOST_DEVICE bool there() const { return state == State::there; }
  WEIR_HOST_DEVICE double cost(double key) const { return squared_error + key * bytes; }
};

WEIR_HOST_DEVICE inline KnownRung known_rung(const RungCost& cost) {
  if (cost.bits == 0) return {};
  if (cost.bits + 8 >= 8 * kRawStreamBytes) return {KnownRung::State::none};
  return {KnownRung::State::there, cost.bits / 8.0, cost.squared_error};
}

WEIR_HOST_DEVICE inline KnownRung known_rung(const NearCost& cost) {
  if (cost.bytes == 0) return {};
  if (cost.bytes >= kRawStreamBytes) return {KnownRung::State::none};
  return {KnownRung::State::there, static_cast<double>(cost.bytes), cost.squared_error};
}

// A rung ends this search if it costs this many bytes more than the best one. The search of ladder_window.h ends at
// one byte, but its shares are rounded; with two bytes the device looks at least as far.
inline constexpr double kSureBytes = 2;
inline constexpr std::uint32_t kNoRung = ~0U;

// Returns the first rung that a search reaches before it was looked at, or kNoRung. The rungs [0, count) go from
// coarse to fine; the search begins at `start` and ignores other rungs. `energy` is the error of the mean alone.
template <class At>
WEIR_HOST_DEVICE std::uint32_t next_rung(const SearchKeys& keys, double energy, std::uint32_t start,
                                         std::uint32_t count, const At& at) {
  std::uint32_t coarse = start;
  KnownRung first = at(coarse);
  while (first.state == KnownRung::State::none && coarse > 0) first = at(--coarse);
  if (first.state == KnownRung::State::not_looked_at) return coarse;
  if (!first.there()) return kNoRung;
  double best = first.cost(keys.low);
  for (std::uint32_t fine = coarse + 1; fine < count; ++fine) {
    const KnownRung next = at(fine);
    if (next.state == KnownRung::State::not_looked_at) return fine;
    if (!next.there()) break;
    const double here = next.cost(keys.low);
    if (here > best + kSureBytes * keys.low) break;
    best = here < best ? here : best;
  }
  best = first.cost(keys.high);
  const double mean_alone = energy + keys.high;
  while (coarse > 0) {
    const KnownRung next = at(--coarse);
    if (next.state == KnownRung::State::not_looked_at) return coarse;
    if (!next.there()) break;
    const double here = next.cost(keys.high);
    const double sure = kSureBytes * keys.high;
    if (here > best + sure && here < mean_alone - sure) break;
    best = here < best ? here : best;
  }
  return kNoRung;
}

// Returns whether `ahead` is so much better than `behind` that the search around `behind` is left out. The condition
// is that of is_far_ahead() of ladder_window.h, and slightly stricter.
WEIR_HOST_DEVICE inline bool is_sure_to_lead(const SearchKeys& keys, const KnownRung& ahead, const KnownRung& behind) {
  if (!keys.compares || !ahead.there() || !behind.there()) return false;
  constexpr double kBitAValue = 512 / 8.0;
  const double error = behind.squared_error - ahead.squared_error;
  const double bytes = kBitAValue + kSureBytes - (behind.bytes - ahead.bytes);
  return error > keys.low * bytes && error > keys.high * bytes;
}

}  // namespace weir::encode_detail
