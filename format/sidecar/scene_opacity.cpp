#include "format/sidecar/scene_opacity.h"

#include <cmath>

namespace weir {

namespace {

// The share of its opacity that a peak may lose; such a loss does not show in its shape.
constexpr double kMissedShare = 0.1;

// Returns the highest entry that a look-up near `position` blends; for a position at an entry, also the entries beside
// it.
double highest_around(const std::vector<float>& table, double position) {
  const auto last = static_cast<double>(table.size() - 1);
  const double at = position * last;
  const auto first = table.begin() + static_cast<std::ptrdiff_t>(std::max(std::ceil(at) - 1, 0.0));
  const auto end = table.begin() + static_cast<std::ptrdiff_t>(std::min(std::floor(at) + 1, last)) + 1;
  return static_cast<double>(*std::max_element(first, end));
}

double loss(const MissedBand& band) { return band.opacity - band.shown; }

}  // namespace

std::vector<float> opacity_table(const std::vector<OpacityPoint>& points) {
  std::vector<float> table(kTransferEntries);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double position = static_cast<double>(i) / static_cast<double>(kTransferEntries - 1);
    table[i] = interpolate(
        points, position, [](const OpacityPoint& p) { return static_cast<float>(p.opacity); },
        [](float a, float b, float f) { return (1.0F - f) * a + f * b; });
  }
  return table;
}

std::optional<MissedBand> missed_band(const std::vector<OpacityPoint>& points) {
  const std::vector<float> table = opacity_table(points);
  std::optional<MissedBand> worst;
  std::optional<MissedBand> band;  // the band of the previous points
  const auto end_band = [&] {
    if (band && (!worst || loss(*band) > loss(*worst))) worst = band;
    band.reset();
  };
  for (const OpacityPoint& point : points) {
    const double shown = highest_around(table, point.position);
    if (point.opacity - shown <= kMissedShare * point.opacity) {
      end_band();
      continue;
    }
    if (!band) band = MissedBand{point.position, point.position, point.opacity, shown};
    band->to = point.position;
    band->opacity = std::max(band->opacity, point.opacity);
    band->shown = std::max(band->shown, shown);
  }
  end_band();
  return worst;
}

}  // namespace weir
