#include "format/sidecar/valid_voxels.h"

#include "format/base/share_text.h"
#include "format/base/text.h"

namespace weir {
namespace {

std::uint64_t all_voxels(const Sidecar& s) {
  return static_cast<std::uint64_t>(s.source.extent.x) * static_cast<std::uint64_t>(s.source.extent.y) *
         static_cast<std::uint64_t>(s.source.extent.z);
}

// Returns the policy for missing voxels, also for files of weir 0.1.
std::string policy_of(const Sidecar& s) {
  if (!s.missing.policy.empty()) return s.missing.policy;
  return s.nonfinite.policy == "keep" ? "nan" : "background";
}

}  // namespace

std::uint64_t valid_voxels(const Sidecar& s) {
  const std::uint64_t without = s.nonfinite.count + (policy_of(s) == "keep" ? 0 : s.missing.count);
  return all_voxels(s) - without;
}

namespace {

// Returns whether other values replace voxels that are not finite or hold no data.
bool replaces_voxels(const Sidecar& s) {
  return (s.nonfinite.count > 0 && s.nonfinite.policy != "keep") || (s.missing.count > 0 && policy_of(s) != "keep");
}

}  // namespace

bool lossless_everywhere(const Sidecar& s) { return s.error.lossless && !replaces_voxels(s); }

std::string lossless_text(const Sidecar& s) { return replaces_voxels(s) ? "lossless over valid voxels" : "lossless"; }

namespace {

// Returns "1234 of 8000 voxels (15.4 %) " with the first of the two verbs for one voxel, the second for several.
std::string counted(const Sidecar& s, std::uint64_t count, const char* of_one, const char* of_several) {
  return cat(count, " of ", all_voxels(s), " voxels (", share_text(count, all_voxels(s)), ") ",
             count == 1 ? of_one : of_several);
}

// Describes voxels that the background replaces, as the end of a sentence. An inexact block changes them like its other
// voxels, and a block kept as its mean gives them the mean.
std::string under_background(const Sidecar& s, bool one) {
  if (s.error.lossless && s.budget.kind == "lossless") {
    return one ? " and reads as the background" : " and read as the background";
  }
  if (s.error.lossless) {
    return cat(one ? "; it reads" : "; they read", " as the background, ", short_number(s.background.value),
               ", or as the nearest value that their block holds");
  }
  return cat(one ? "; it reads" : "; they read", " as the background, ", short_number(s.background.value),
             ", only where a block is exact, and ", one ? "its" : "their", " error is not counted");
}

}  // namespace

std::string missing_text(const Sidecar& s) {
  const std::uint64_t count = s.missing.count;
  if (count == 0) return "";
  const std::string policy = policy_of(s);
  const bool one = count == 1;
  if (s.source.level) {
    const bool marked = !s.missing.values.empty();
    return cat(counted(s, count, "is", "are"), " not of this level", marked ? " or without data" : "",
               ", and inactive");
  }
  const std::string without = counted(s, count, "holds no data", "hold no data");
  if (policy == "keep") return without + (one ? " and is kept as data" : " and are kept as data");
  if (policy == "nan") return without + (one ? " and reads NaN" : " and read NaN");
  return without + under_background(s, one);
}

std::string nonfinite_text(const Sidecar& s) {
  const std::uint64_t count = s.nonfinite.count;
  if (count == 0 || s.nonfinite.policy == "keep") return "";
  return counted(s, count, "is NaN or infinite", "are NaN or infinite") + under_background(s, count == 1);
}

std::string lost_zeros_text(std::uint64_t lost, std::uint64_t zeros) {
  return lost == 0 ? "" : cat(lost, " of ", zeros, " zeros (", share_text(lost, zeros), ") lost");
}

}  // namespace weir
