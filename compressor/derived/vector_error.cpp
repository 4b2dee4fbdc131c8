#include "compressor/derived/vector_error.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "compressor/derived/neighbours.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

/// derivatives[c][a] is the derivative of component c along axis a.
using Derivatives = std::array<std::array<double, 3>, 3>;

double squared_vorticity(const Derivatives& d) {
  const double x = d[2][1] - d[1][2];
  const double y = d[0][2] - d[2][0];
  const double z = d[1][0] - d[0][1];
  return x * x + y * y + z * z;
}

double squared_divergence(const Derivatives& d) {
  const double sum = d[0][0] + d[1][1] + d[2][2];
  return sum * sum;
}

/// Sums of a quantity's squares over many voxels.
struct QuantityTally {
  ExactSum error;
  ExactSum source;
  double largest = 0;

  void merge(const QuantityTally& other) {
    error.add(other.error);
    source.add(other.source);
    largest = std::max(largest, other.largest);
  }

  QuantityError result(std::uint64_t voxels) const {
    QuantityError all;
    all.max_abs = std::sqrt(largest);
    if (voxels == 0) return all;
    all.rms = std::sqrt(error.value() / static_cast<double>(voxels));
    all.source_rms = std::sqrt(source.value() / static_cast<double>(voxels));
    if (source.value() > 0) all.relative_rms = std::sqrt(error.value() / source.value());
    return all;
  }
};

/// The tally of one thread. Sums do not depend on the order and the grouping of the parts.
class VectorTally {
 public:
  explicit VectorTally(const std::array<double, 3>& spacing) : spacing_(spacing) {}

  void add(std::span<const ValuePair> values, const Box& part) {
    Sums vorticity;
    Sums divergence;
    for_each_index(part, [&](const Index3& i) {
      Derivatives error{};
      Derivatives source{};
      if (!differentiate(values, i, error, source)) {
        ++left_out_;
        return;
      }
      ++voxels_;
      vorticity.add(squared_vorticity(error), squared_vorticity(source));
      divergence.add(squared_divergence(error), squared_divergence(source));
    });
    vorticity.add_to(vorticity_);
    divergence.add_to(divergence_);
  }

  void merge(const VectorTally& other) {
    vorticity_.merge(other.vorticity_);
    divergence_.merge(other.divergence_);
    voxels_ += other.voxels_;
    left_out_ += other.left_out_;
  }

  VectorErrors result() const { return {vorticity_.result(voxels_), divergence_.result(voxels_), voxels_, left_out_}; }

 private:
  /// Sums over one block of 8^3.
  struct Sums {
    double error = 0;
    double source = 0;
    double largest = 0;

    void add(double of_error, double of_source) {
      error += of_error;
      source += of_source;
      largest = std::max(largest, of_error);
    }
    void add_to(QuantityTally& tally) const {
      tally.error.add(error);
      tally.source.add(source);
      tally.largest = std::max(tally.largest, largest);
    }
  };

  // Finds the derivatives at voxel `i`. Returns false if a value is not finite.
  bool differentiate(std::span<const ValuePair> values, const Index3& i, Derivatives& error,
                     Derivatives& source) const {
    const std::array<Neighbours, 3> axes = neighbours_of(values.front(), i, spacing_);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t a = 0; a < 3; ++a) {
        const auto& [low, high, length] = axes[a];
        if (length == 0) continue;  // an axis of one voxel
        const ValuePair& one = values[c];
        if (!one.finite(low) || !one.finite(high)) return false;
        error[c][a] = (one.error(high) - one.error(low)) / length;
        source[c][a] = (static_cast<double>(one.source[high]) - static_cast<double>(one.source[low])) / length;
      }
    }
    return true;
  }

  std::array<double, 3> spacing_;
  QuantityTally vorticity_;
  QuantityTally divergence_;
  std::uint64_t voxels_ = 0;
  std::uint64_t left_out_ = 0;
};

std::string spacing_text(const SourceInfo& info) {
  return cat(info.spacing[0], ',', info.spacing[1], ',', info.spacing[2]);
}

void check_alike(const std::array<PairedVolume, 3>& components) {
  constexpr const char* kRemedy = "; give the three components of one field";
  const SourceInfo& first = components[0].source.info();
  for (const PairedVolume& one : components) {
    const SourceInfo& info = one.source.info();
    const Box domain = info.domain();
    if (domain != first.domain()) {
      throw Error(ErrorKind::input, cat(info.path, ": holds the voxels ", box_text(domain), ", ", first.path, " holds ",
                                        box_text(first.domain()), kRemedy));
    }
    if (info.spacing != first.spacing) {
      throw Error(ErrorKind::input, cat(info.path, ": has the spacing ", spacing_text(info), ", ", first.path, " has ",
                                        spacing_text(first), kRemedy));
    }
    if (one.grid.index_bbox() != domain) {
      throw Error(ErrorKind::input, cat(info.path, ": holds the voxels ", box_text(domain), ", its file ",
                                        box_text(one.grid.index_bbox()), "; give the file that was made from it"));
    }
  }
}

}  // namespace

VectorErrors vector_errors(const std::array<PairedVolume, 3>& components, const CompareOptions& options) {
  check_alike(components);
  const VectorTally none(components[0].source.info().spacing);
  tbb::enumerable_thread_specific<VectorTally> tallies(none);
  stream_pairs(components, {1, 1}, options,
               [&](std::span<const ValuePair> values, const Box& part) { tallies.local().add(values, part); });
  VectorTally total = none;
  for (const VectorTally& tally : tallies) total.merge(tally);
  return total.result();
}

}  // namespace weir
