// Charts of a sweep: error against size, and error against time.
#pragma once

#include <string>

#include "tools/plot/plot_canvas.h"
#include "tools/sweep/sweep_report.h"

namespace weir {

enum class SweepAxis { bits_per_voxel, seconds };

/// Returns the bytes of a chart file, 900 x 600 pixels: PSNR upwards, `axis` to the right on a logarithmic scale, a
/// legend, and a line for each method through its rates in the report's order. Lossless results, which have no PSNR,
/// lie in a band at the top. Throws as make_plot_canvas.
std::string psnr_chart(const SweepReport& report, SweepAxis axis, PlotFormat format);

}  // namespace weir
