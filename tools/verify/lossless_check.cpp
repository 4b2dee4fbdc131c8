#include "tools/verify/lossless_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "format/base/text.h"
#include "format/sidecar/valid_voxels.h"

namespace weir {
namespace {

// Returns whether the counted voxels are all voxels of the source, with its values.
bool holds_source(const TreeCensus& census, float background, const Sidecar& s) {
  return s.zeros && std::isfinite(background) && lossless_everywhere(s) &&
         census.valued_voxels + census.quiet_voxels == static_cast<std::uint64_t>(volume(s.grid.extent));
}

// Returns `census` including the voxels of inactive tiles, which have the background value.
TreeCensus with_quiet_voxels(TreeCensus census, float background) {
  const std::uint64_t quiet = census.quiet_voxels;
  if (quiet == 0) return census;
  census.valued_voxels += quiet;
  census.backgrounds += quiet;
  if (background == 0.0F) census.zeros += quiet;
  census.min = std::min(census.min, background);
  census.max = std::max(census.max, background);
  return census;
}

VolumeCheck same_count(const char* name, std::uint64_t decoded, std::uint64_t from_sidecar) {
  return {name, cat(decoded, " decoded"), cat(from_sidecar), decoded == from_sidecar};
}

}  // namespace

std::vector<VolumeCheck> check_lossless(const TreeCensus& counted, float background, const Sidecar& s) {
  if (!holds_source(counted, background, s)) return {};
  const TreeCensus census = with_quiet_voxels(counted, background);
  std::vector<VolumeCheck> checks{same_count("sidecar nonfinite.count", census.nonfinite, s.nonfinite.count),
                                  same_count("sidecar zeros.count", census.zeros, s.zeros->count),
                                  same_count("sidecar zeros.lost of a lossless file", 0, s.zeros->lost)};
  const std::uint64_t finite = census.valued_voxels - census.nonfinite;
  if (finite == 0) return checks;
  const auto [lo, hi] = s.value_range;
  checks.push_back({"sidecar value_range of a lossless file", cat(census.min, " .. ", census.max, " decoded"),
                    cat(lo, " .. ", hi),
                    lo == static_cast<double>(census.min) && hi == static_cast<double>(census.max)});
  if (s.background.method != "mode") return checks;  // the share is of samples or of a bin, or was not counted
  const double share = static_cast<double>(census.backgrounds) / static_cast<double>(finite);
  checks.push_back({"sidecar background.share of a lossless file", cat(share, " decoded"), cat(s.background.share),
                    std::fabs(share - s.background.share) <= 1e-9});
  return checks;
}

}  // namespace weir
