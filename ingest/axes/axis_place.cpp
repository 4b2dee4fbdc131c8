#include "ingest/axes/axis_place.h"

#include <cstddef>

#include "format/base/text.h"
#include "ingest/source/index_choice.h"

namespace weir {

std::string axes_text(std::span<const AxisPlace> axes) {
  std::string text;
  for (const AxisPlace& axis : axes) {
    text += cat(text.empty() ? "" : " x ", axis.label, axis.label.empty() ? "" : "=", axis.extent);
  }
  return text;
}

std::string unwritten_note(std::span<const AxisPlace> axes) {
  std::string text;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisPlace& axis = axes[i];
    if (axis.unwritten == 0 || axis.extent < 1) continue;
    text +=
        cat(text.empty() ? "" : "; ", axis.label.empty() ? "its " : "its dimension ", axis_name(axis.label, i), " has ",
            axis.extent + axis.unwritten, " elements, of which ", axis.extent, axis.extent == 1 ? " is" : " are",
            " written here: positions count these, and the last one is ", axis.extent - 1);
  }
  return text;
}

}  // namespace weir
