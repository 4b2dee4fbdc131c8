#include "ingest/axes/axis_place.h"

#include "format/base/text.h"

namespace weir {

std::string axes_text(std::span<const AxisPlace> axes) {
  std::string text;
  for (const AxisPlace& axis : axes) {
    text += cat(text.empty() ? "" : " x ", axis.label, axis.label.empty() ? "" : "=", axis.extent);
  }
  return text;
}

}  // namespace weir
