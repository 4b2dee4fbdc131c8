#include "tools/report/opacity_warning.h"

#include <array>
#include <cstdio>
#include <optional>

#include "format/base/text.h"
#include "format/sidecar/scene_opacity.h"

namespace weir {
namespace {

// Entries are a thousandth of the range apart, so four digits could not tell apart the ends of a band between two
// entries.
std::string six_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string stretch_text(double from, double to) {
  const std::string first = six_digits(from);
  const std::string last = six_digits(to);
  return first == last ? first : cat(first, " to ", last);
}

}  // namespace

std::string opacity_warning(const Scene& scene) {
  const SceneVolume& volume = scene.volume;
  if (scene.mode == RenderMode::iso || volume.opacity.empty()) return {};
  if (volume.range && !((*volume.range)[0] < (*volume.range)[1])) return {};
  const std::optional<MissedBand> band = missed_band(volume.opacity);
  if (!band) return {};
  std::string values;
  if (volume.range) {
    const auto [low, high] = *volume.range;
    const auto value_at = [low = low, high = high](double at) { return low + at * (high - low); };
    values = cat(band->from < band->to ? " (values " : " (value ",
                 stretch_text(value_at(band->from), value_at(band->to)), ')');
  }
  return cat("opacity ", short_number(band->opacity), " at ", stretch_text(band->from, band->to), " of the range",
             values, " is taken as ", band->shown > 0 ? "at most " : "", short_number(band->shown),
             ", since it lies between two of the ", kTransferEntries,
             " entries that the range has; give a narrower range");
}

}  // namespace weir
