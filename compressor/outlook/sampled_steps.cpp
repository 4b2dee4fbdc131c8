#include "compressor/outlook/sampled_steps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

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

void SampledSteps::Part::add(const SampledBlock& block, const LeafStep& step) {
  const bool near = step.level == kExactLevel ? block.ordered : step.level >= kFirstNearLevel;
  steps_.push_back({step.gain, step.bytes, static_cast<std::uint32_t>(bucket_of(step.key)),
                    static_cast<std::uint32_t>(block.row), static_cast<std::uint32_t>(block.region),
                    !near          ? Near::no
                    : block.sparse ? Near::of_sparse
                                   : Near::of_other});
}

SampledSteps::SampledSteps(float width, std::size_t rows, std::vector<Part> parts)
    : width_(width), rows_(rows), parts_(std::move(parts)) {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  std::size_t most = 0;
  for (const Part& part : parts_) {
    for (const Part::Step& step : part.steps_) {
      least = std::min<std::size_t>(least, step.bucket);
      most = std::max<std::size_t>(most, step.bucket);
    }
  }
  if (least > most) return;
  first_ = least;
  buckets_.resize(most - least + 1);
  for (const Part& part : parts_) {
    for (const Part::Step& step : part.steps_) {
      Bucket& bucket = buckets_[step.bucket - first_];
      const auto bytes = static_cast<double>(step.bytes);
      bucket.bytes.all += bytes;
      bucket.gain += step.gain;
      if (step.near == Part::Near::of_sparse) bucket.bytes.near_sparse += bytes;
      if (step.near == Part::Near::of_other) bucket.bytes.near_other += bytes;
    }
  }
}

SampledCut SampledSteps::within_bytes(double bytes) const {
  BoughtBytes bought;
  std::size_t cut = end();
  while (cut > first_ && bought.all <= bytes) bought.add(bucket(--cut).bytes);
  if (bought.all <= bytes) return {bought.near(), std::nullopt, bought.all, 0};
  return {bought.near(), KeyWindow::about(key_of(cut), width_, reach_at(cut, bytes)), bought.all, key_of(cut)};
}

std::optional<SampledCut> SampledSteps::within_error(double squared_error) const {
  double left = 0;
  for (std::size_t cut = first_; cut < end(); ++cut) {
    left += bucket(cut).gain;
    if (left <= squared_error) continue;
    BoughtBytes bought;
    for (std::size_t i = cut; i < end(); ++i) bought.add(bucket(i).bytes);
    // The error is given as a part of the values' range, which is known too roughly for a narrower window.
    return SampledCut{bought.near(), KeyWindow::about(key_of(cut), width_), bought.all, key_of(cut)};
  }
  return std::nullopt;
}

std::size_t SampledSteps::bucket_of(double key) { return key_bits(key) >> kDropped; }

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
  std::size_t at = end();
  const auto key_at = [&](double most) {
    while (at > first_ && bought <= most) bought += bucket(--at).bytes.all;
    return bought > most ? key_of(at) : 0;
  };
  const double high = key_at(bytes - off);
  const double low = key_at(bytes + off);
  if (!(low > 0)) return KeyWindow::kMostReach;
  const double reach = std::max(high / key_of(cut), key_of(cut) / low);
  return std::clamp(kBeside * reach, kLeast, KeyWindow::kMostReach);
}

// Estimates the deviation by the differences of neighbouring rows, because each row stands for its own part of the
// volume.
double SampledSteps::deviation_at(std::size_t cut) const {
  if (rows_ < 2) return std::numeric_limits<double>::infinity();
  std::vector<double> bytes(rows_);
  for (const Part& part : parts_) {
    for (const Part::Step& step : part.steps_) {
      if (step.bucket >= cut) bytes[step.row] += static_cast<double>(step.bytes);
    }
  }
  double squares = 0;
  for (std::size_t row = 1; row < rows_; ++row) squares += std::pow(bytes[row] - bytes[row - 1], 2);
  const auto rows = static_cast<double>(rows_);
  return std::sqrt(squares / 2 * rows / (rows - 1));
}

}  // namespace weir
