#include "compressor/scene_notice.h"

#include "format/base/text.h"

namespace weir {

Message scene_notice(const Sidecar& sidecar, const std::string& output) {
  if (!sidecar.visible || sidecar.visible->blocks > 0) return {};
  return compose(output, ": ", sidecar.visible->scene, " shows nothing of ", sidecar.source.path,
                 ", whose values are from ", short_number(sidecar.value_range[0]), " to ",
                 short_number(sidecar.value_range[1]), "; correct its range, opacity or region, or leave out ",
                 option("scene"));
}

}  // namespace weir
