#include "compressor/outlook/sampled_steps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "compressor/select/step_keys.h"

namespace weir {

void BoughtBytes::add(const BoughtBytes& bytes) {
  all += bytes.all;
  near_sparse += bytes.near_sparse;
  near_other += bytes.near_other;
}

NearBlocks BoughtBytes::near() const {
  // Fewer are not worth their time; with a fiftieth by other blocks, a file takes 5 % fewer bytes.
  const double least = all / 256;
  if (near_other > least) return NearBlocks::all;
  return near_sparse > least ? NearBlocks::sparse : NearBlocks::none;
}

void SampledSteps::add(const Block& block, const LeafStep& step) {
  const std::uint64_t at = key_bits(step.key) >> kDropped;
  Bucket& bucket = buckets_[at];
  const auto bytes = static_cast<double>(step.bytes);
  bucket.bytes.all += bytes;
  bucket.gain += step.gain;
  steps_.push_back({static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(block.row), bytes});
  const bool exact = step.level == kExactLevel;
  if (!(exact ? block.ordered : step.level >= kFirstNearLevel)) return;
  (block.sparse ? bucket.bytes.near_sparse : bucket.bytes.near_other) += bytes;
}

SampledCut SampledSteps::within_bytes(double bytes) const {
  BoughtBytes bought;
  std::size_t cut = buckets_.size();
  while (cut > 0 && bought.all <= bytes) bought.add(buckets_[--cut].bytes);
  SampledCut found{bought.near(), std::nullopt, bought.all, key_of(cut)};
  if (bought.all > bytes) found.window = KeyWindow::about(key_of(cut), width_, reach_at(cut, bytes));
  return found;
}

std::optional<SampledCut> SampledSteps::within_error(double squared_error) const {
  double left = 0;
  for (std::size_t cut = 0; cut < buckets_.size(); ++cut) {
    left += buckets_[cut].gain;
    if (left <= squared_error) continue;
    BoughtBytes bought;
    for (std::size_t i = cut; i < buckets_.size(); ++i) bought.add(buckets_[i].bytes);
    // The range of the values, which the error is a part of, is known too roughly for a narrower window.
    return SampledCut{bought.near(), KeyWindow::about(key_of(cut), width_), bought.all, key_of(cut)};
  }
  return std::nullopt;
}

double SampledSteps::key_of(std::size_t bucket) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(bucket) << kDropped);
}

double SampledSteps::reach_at(std::size_t cut, double bytes) const {
  constexpr double kDeviations = 3;
  constexpr double kBeside = 1.15;  // lower nodes, and steps of one key, move the cut a little
  constexpr double kLeast = 1.25;
  const double off = kDeviations * deviation_at(cut);
  if (!(off < bytes)) return KeyWindow::kMostReach;
  double bought = 0;
  std::size_t bucket = buckets_.size();
  const auto key_at = [&](double most) {
    while (bucket > 0 && bought <= most) bought += buckets_[--bucket].bytes.all;
    return bought > most ? key_of(bucket) : 0;
  };
  const double high = key_at(bytes - off);
  const double low = key_at(bytes + off);
  if (!(low > 0)) return KeyWindow::kMostReach;
  const double reach = std::max(high / key_of(cut), key_of(cut) / low);
  return std::clamp(kBeside * reach, kLeast, KeyWindow::kMostReach);
}

// By the differences of neighbours: each row stands for its own part of the volume.
double SampledSteps::deviation_at(std::size_t cut) const {
  if (rows_ < 2) return std::numeric_limits<double>::infinity();
  std::vector<double> bytes(rows_);
  for (const Step& step : steps_) {
    if (step.bucket >= cut) bytes[step.row] += step.bytes;
  }
  double squares = 0;
  for (std::size_t row = 1; row < rows_; ++row) squares += std::pow(bytes[row] - bytes[row - 1], 2);
  const auto rows = static_cast<double>(rows_);
  return std::sqrt(squares / 2 * rows / (rows - 1));
}

}  // namespace weir
