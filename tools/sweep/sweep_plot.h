// Charts of a sweep: error against size, and error against time.
#pragma once

#include "gpu/image/image.h"
#include "tools/sweep/sweep_report.h"

namespace weir {

enum class SweepAxis { bits_per_voxel, seconds };

/// 900 x 600 pixels: PSNR upwards, `axis` to the right on a logarithmic scale, a line for each method through
/// its rates in the report's order, a legend. Lossless results, which have no PSNR, lie in a band at the top.
Image psnr_plot(const SweepReport& report, SweepAxis axis);

}  // namespace weir
