// How far the device looks at the rungs of a block, where it is known between which keys the cut lies: as far as the
// search of compressor/packed/ladder_window.h comes, or a little further. Of a block whose voxels all lie in the
// volume: of others the search goes by the error of those that do, which the device does not know. Nothing depends on
// it but time: a block whose search comes to a rung that was not looked at is the host's. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_coder.h"
#include "format/packed/stream_length.h"

namespace weir::encode_detail {

// A rung, as far as it is known: what it takes in bytes, and the squared error that it leaves.
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

// A rung costs more than the best one where it does so by more bytes than the search's one: its shares are rounded.
inline constexpr double kSureBytes = 2;
inline constexpr std::uint32_t kNoRung = ~0U;

// The first rung that a search comes to without it having been looked at, or kNoRung. Of rungs [0, count), from coarse
// to fine; it begins at `start`, and what lies beyond them is none of its. `energy`: the error of the mean alone.
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

// Whether `ahead` is so much the better buy that the search about `behind` is left out: is_far_ahead() of
// ladder_window.h, and somewhat more.
WEIR_HOST_DEVICE inline bool is_sure_to_lead(const SearchKeys& keys, const KnownRung& ahead, const KnownRung& behind) {
  if (!keys.compares || !ahead.there() || !behind.there()) return false;
  constexpr double kBitAValue = 512 / 8.0;
  const double error = behind.squared_error - ahead.squared_error;
  const double bytes = kBitAValue + kSureBytes - (behind.bytes - ahead.bytes);
  return error > keys.low * bytes && error > keys.high * bytes;
}

}  // namespace weir::encode_detail
