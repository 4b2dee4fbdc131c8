// Draws a histogram as text for a terminal and as an image. Counts are on a logarithmic scale, because the background
// alone often holds most voxels.
#pragma once

#include <optional>
#include <string>

#include "format/sidecar/sidecar.h"
#include "tools/plot/plot_canvas.h"

namespace weir {

/// Returns bars of '#', at most 64 wide and 10 high, with axes: several lines, each ending in a newline. Returns one
/// line that says so if there is nothing to show.
std::string histogram_text(const Sidecar::Histogram& histogram);

/// The texts on a chart.
struct HistogramLabels {
  std::string title;   ///< above the chart: what the volume is
  std::string values;  ///< below the value axis, with units
};

/// Returns the bytes of an image file of 720 x 384 pixels with labels, axes, decade lines, and a mark at `background`
/// if that is given and inside the range. Throws as make_plot_canvas.
std::string histogram_chart(const Sidecar::Histogram& histogram, std::optional<double> background,
                            const HistogramLabels& labels, PlotFormat format);

}  // namespace weir
