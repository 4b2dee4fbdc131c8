#include "compressor/forecast/work_time.h"

#include <algorithm>
#include <vector>

#include "compressor/outlook/budget_outlook.h"
#include "format/base/index.h"

namespace weir {

double scaled_time(double sample_s, double sample_voxels, std::span<const double> parts_s, double part_voxels,
                   double voxels) {
  const double in_proportion = sample_s / sample_voxels * voxels;
  if (parts_s.empty()) return in_proportion;
  std::vector<double> sorted(parts_s.begin(), parts_s.end());
  std::ranges::sort(sorted);
  const double part_s = (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
  if (part_s >= sample_s) return in_proportion;
  const double each = (sample_s - part_s) / (sample_voxels - part_voxels);
  return std::min(in_proportion, sample_s + each * (voxels - sample_voxels));
}

bool are_like_volume(Encoding encoding, double part_voxels) {
  return encoding != Encoding::packed || part_voxels >= static_cast<double>(kLeastForecastBlocks * kLeafVoxels);
}

double pass_time(double work_s, std::size_t threads, double voxels, const ReadCost& cost) {
  return std::max(cost.wall_s * voxels, work_s + cost.cpu_s * voxels / static_cast<double>(threads));
}

}  // namespace weir
