#include "compressor/derived/error_histogram.h"

#include <algorithm>
#include <cmath>

namespace weir {

std::size_t ErrorHistogram::bin_of(double size) {
  if (size == 0) return 0;
  int exponent = 0;
  const double fraction = std::frexp(size, &exponent);  // in [0.5, 1): the octave is exponent - 1
  const int octave = std::clamp(exponent - 1, kLowest, kHighest - 1);
  const auto part = static_cast<int>((fraction - 0.5) * (2 * kInOctave));
  return 1 + static_cast<std::size_t>((octave - kLowest) * kInOctave + part);
}

double ErrorHistogram::end_of(std::size_t bin) {
  if (bin == 0) return 0;
  const int number = static_cast<int>(bin) - 1;
  return std::ldexp(1.0 + static_cast<double>(number % kInOctave + 1) / kInOctave, number / kInOctave + kLowest);
}

void ErrorHistogram::add(double size) {
  ++counts_[bin_of(size)];
  ++count_;
}

void ErrorHistogram::add(const ErrorHistogram& other) {
  for (std::size_t i = 0; i < kBins; ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
}

double ErrorHistogram::quantile(double share, double largest) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    seen += counts_[bin];
    if (seen >= wanted) return std::min(end_of(bin), largest);
  }
  return largest;
}

ErrorHistogram::Octaves ErrorHistogram::octaves() const {
  Octaves all;
  all.zeros = counts_[0];
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(kHighest - kLowest));
  for (std::size_t bin = 1; bin < kBins; ++bin) counts[(bin - 1) / kInOctave] += counts_[bin];
  const auto some = [](std::uint64_t count) { return count > 0; };
  const auto first = std::find_if(counts.begin(), counts.end(), some);
  const auto last = std::find_if(counts.rbegin(), counts.rend(), some).base();
  if (first == counts.end()) return all;
  all.first = static_cast<int>(first - counts.begin()) + kLowest;
  all.counts.assign(first, last);
  return all;
}

}  // namespace weir
