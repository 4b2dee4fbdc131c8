// What weir_plot.so does.
#pragma once

#include "tools/plot/plot_canvas.h"

namespace weir {

struct PlotDriver {
  std::unique_ptr<PlotCanvas> (*make)(std::int32_t width, std::int32_t height, PlotFormat format, const Float3& paper);
};

}  // namespace weir
