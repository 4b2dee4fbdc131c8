#include "format/sidecar/scene_opacity.h"

namespace weir {

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

}  // namespace weir
