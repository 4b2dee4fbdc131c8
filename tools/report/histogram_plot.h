// A histogram as a picture: on a terminal and as an image. Counts are shown on
// a logarithmic scale, since the background alone often holds most voxels.
#pragma once

#include <optional>
#include <string>

#include "format/sidecar/sidecar.h"
#include "tools/plot/plot_canvas.h"

namespace weir {

/// Bars of '#', at most 64 wide and 10 high, with axes; several lines, each ending in a newline. One
/// line saying so where there is nothing to show.
std::string histogram_text(const Sidecar::Histogram& histogram);

/// What stands on a chart.
struct HistogramLabels {
  std::string title;   ///< above it, what the volume is
  std::string values;  ///< below the axis of values, with their units
};

/// The bytes of a file, 720 x 384 pixels with labels, axes, decade lines, and a mark at `background` where it is given
/// and inside. Throws as make_plot_canvas.
std::string histogram_chart(const Sidecar::Histogram& histogram, std::optional<double> background,
                            const HistogramLabels& labels, PlotFormat format);

}  // namespace weir
