#include "ingest/vtk/vtk_array.h"

#include <cstddef>

#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/source/extent.h"

namespace weir {

VtkVolume vtk_volume(const InputFile& file, const char* format, const VtkImage& image, const VtkArray& array,
                     const SourceOptions& options) {
  VtkVolume volume;
  volume.where = cat(file.path(), ": array ", in_quotes(array.name));
  SourceInfo& info = volume.info;
  info.path = file.path();
  info.format = format;
  info.dataset = array.name;
  info.file_bytes = file.size();
  info.mtime_ns = file.mtime_ns();
  info.files = {file.state()};
  place_vtk_image(image, array.cells, info);
  volume.components = choose_components(array.components, options.component, volume.where);
  if (options.component) info.details.component = component_text(*options.component);
  info.lengths = volume.components.count > 1 && volume.components.choice.magnitude;
  volume.bytes = checked_volume_bytes(
      info.extent, scalar_bytes(array.type) * static_cast<std::size_t>(volume.components.count), volume.where);
  return volume;
}

std::string full_vtk_name(const std::string& name, bool cells) { return cat(cells ? "CellData/" : "PointData/", name); }

}  // namespace weir
