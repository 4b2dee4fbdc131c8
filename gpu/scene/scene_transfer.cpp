#include "gpu/scene/scene_transfer.h"

#include <algorithm>
#include <cmath>

#include "format/sidecar/scene_opacity.h"
#include "gpu/image/colormap.h"

namespace weir {

namespace {

// Values are transparent by default up to this fraction of the largest distance from the background. Otherwise noise
// around the background would veil everything else.
constexpr double kTransparentShare = 0.06;

// Returns the opacity of the entry at `position`, 0 to 1, of a table over [low, high]. Values outside the table take
// the opacity of its end. If the background lies outside, that end is therefore transparent.
double default_opacity(double position, double low, double high, double background) {
  if (!(high > low)) {
    const bool end = (background < low && position == 0) || (background > high && position == 1);
    return end ? 0 : 0.5;  // a constant volume shows as a fog, not as nothing
  }
  const double from = std::isfinite(background) ? std::clamp(background, low, high) : low;
  const double reach = std::max(high - from, from - low);
  const double value = low + position * (high - low);
  const double x = (std::abs(value - from) / reach - kTransparentShare) / (1 - kTransparentShare);
  return x > 0 ? x * std::sqrt(x) : 0;
}

}  // namespace

TransferFunction make_transfer_function(const SceneVolume& volume, MinMax range, float background,
                                        std::string_view default_colormap) {
  if (volume.range) range = {static_cast<float>((*volume.range)[0]), static_cast<float>((*volume.range)[1])};
  const std::string_view name = volume.colormap.empty() ? default_colormap : std::string_view(volume.colormap);
  const std::vector<Float3> colours = colormap(name, kTransferEntries);
  const std::vector<float> opacities = volume.opacity.empty() ? std::vector<float>{} : opacity_table(volume.opacity);
  std::vector<Rgba> table(kTransferEntries);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double position = static_cast<double>(i) / static_cast<double>(kTransferEntries - 1);
    Float3 colour = colours[i];
    if (!volume.color.empty()) {
      const auto srgb_of = [](const ColorPoint& p) {
        return Float3{static_cast<float>(p.srgb[0]), static_cast<float>(p.srgb[1]), static_cast<float>(p.srgb[2])};
      };
      const Float3 srgb = interpolate(volume.color, position, srgb_of,
                                      [](const Float3& a, const Float3& b, float f) { return mix(a, b, f); });
      colour = {linear_from_srgb(srgb.x), linear_from_srgb(srgb.y), linear_from_srgb(srgb.z)};
    }
    const float opacity = opacities.empty()
                              ? static_cast<float>(default_opacity(position, range.min, range.max, background))
                              : opacities[i];
    table[i] = {colour.x, colour.y, colour.z, opacity};
  }
  return {std::move(table), range.min, range.max};
}

}  // namespace weir
