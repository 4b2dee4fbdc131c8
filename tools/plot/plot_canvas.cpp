#include "tools/plot/plot_canvas.h"

#include "format/base/error.h"
#include "ingest/drivers/driver.h"

namespace weir {

PlotFormat plot_format(const std::string& path, std::string_view key) {
  if (path.ends_with(".png")) return PlotFormat::png;
  if (path.ends_with(".svg")) return PlotFormat::svg;
  throw usage_error(compose(option(key, path), ": a chart's name must end in .png or .svg"));
}

std::unique_ptr<PlotCanvas> make_plot_canvas(std::int32_t width, std::int32_t height, PlotFormat format,
                                             const Float3& paper) {
  const auto& driver = *static_cast<const PlotDriver*>(load_driver("plot", "a chart is to be drawn"));
  return driver.make(width, height, format, paper);
}

}  // namespace weir
