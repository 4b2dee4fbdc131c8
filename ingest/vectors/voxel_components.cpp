#include "ingest/vectors/voxel_components.h"

#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

std::string components_obstacle(std::int64_t components) {
  if (components >= 1 && components <= kMostComponents) return "";
  return cat("it has ", components, " components, and one of 1 to ", kMostComponents, " can be read");
}

VoxelComponents choose_components(std::int64_t components, const std::optional<ComponentChoice>& choice,
                                  const std::string& where) {
  if (components == 1) {
    if (!choice) return {};
    throw Error(ErrorKind::usage,
                compose(where, ": has one value a voxel, and no components; leave ", option("component"), " out"));
  }
  const std::string_view names = components == 2 ? ", x, y" : components == 3 ? ", x, y, z" : "";
  const std::string choices = cat("0 to ", components - 1, names, " or magnitude");
  if (!choice) {
    throw Error(ErrorKind::usage, compose(where, ": has ", cat(components), " components a voxel; give ",
                                          option("component"), ": ", choices));
  }
  if (!choice->magnitude && choice->position >= components) {
    throw Error(ErrorKind::usage, compose(where, ": has ", cat(components), " components a voxel, and ",
                                          option("component"), " is ", cat(choice->position), "; give ", choices));
  }
  return {components, *choice};
}

}  // namespace weir
