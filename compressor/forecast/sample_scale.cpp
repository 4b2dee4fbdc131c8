#include "compressor/forecast/sample_scale.h"

#include <algorithm>
#include <cmath>

#include "compressor/select/file_size.h"
#include "compressor/select/fixed_bytes.h"

namespace weir {

SampleScale::SampleScale(const Box& volume, const Box& sample, const ConversionOptions& options,
                         const SampledNodes& nodes)
    : volume_(volume),
      sample_(sample),
      options_(options),
      nodes_(nodes),
      share_(static_cast<double>(make_lattice(sample, kLeafDim).size()) /
             static_cast<double>(make_lattice(volume, kLeafDim).size())) {}

double SampleScale::fixed_of_volume(Encoding encoding, Preview preview, std::uint64_t asked) const {
  return static_cast<double>(fixed_bytes(volume_, encoding, preview, asked, nodes_.of_volume));
}

double SampleScale::fixed_of_sample(Encoding encoding, Preview preview, std::uint64_t asked) const {
  return static_cast<double>(fixed_bytes(sample_, encoding, preview, asked, nodes_.of_sample));
}

Budget SampleScale::budget() const {
  const bool by_size = options_.budget.by_size() || options_.budget.kind == Budget::Kind::automatic;
  if (!by_size || volume_ == sample_) return options_.budget;
  const std::uint64_t dense = float32_bytes(volume_);
  const std::uint64_t asked = asked_bytes(options_.budget, dense);
  const auto in_proportion = static_cast<std::uint64_t>(std::ceil(static_cast<double>(asked) * share_));
  const double left = static_cast<double>(asked) - fixed_of_volume(options_.encoding, options_.preview, asked);
  const double bytes = left * share_ + fixed_of_sample(options_.encoding, options_.preview, in_proportion);
  Budget budget = options_.budget;
  budget.kind = Budget::Kind::size;
  budget.bytes = static_cast<std::uint64_t>(std::max(1.0, std::ceil(bytes)));
  return budget;
}

double SampleScale::file_bytes(const Sidecar& of_sample) const {
  const auto bytes = static_cast<double>(of_sample.file.bytes);
  if (volume_ == sample_) return bytes;
  const Encoding encoding = of_sample.packed ? Encoding::packed : Encoding::float32;
  const Preview preview = of_sample.packed && of_sample.packed->preview ? Preview::on : Preview::off;
  const double bought = bytes - fixed_of_sample(encoding, preview, 0);
  return std::max(0.0, fixed_of_volume(encoding, preview, 0) + bought / share_);
}

}  // namespace weir
