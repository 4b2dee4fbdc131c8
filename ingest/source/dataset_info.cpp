#include "ingest/source/dataset_info.h"

#include <utility>

namespace weir {

std::vector<DatasetInfo> list_single(const SourceInfo& info, std::string layout) {
  DatasetInfo only;
  only.extents = {info.extent.x, info.extent.y, info.extent.z};
  only.type = scalar_name(info.type);
  only.layout = std::move(layout);
  return {only};
}

}  // namespace weir
