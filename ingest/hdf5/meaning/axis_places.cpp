#include "ingest/hdf5/meaning/axis_places.h"

#include "ingest/axes/component_axis.h"
#include "ingest/hdf5/meaning/auxiliary_times.h"
#include "ingest/hdf5/meaning/dimension_scales.h"
#include "ingest/hdf5/meaning/openpmd.h"
#include "ingest/hdf5/meaning/plain_placement.h"
#include "ingest/hdf5/meaning/vtk_hdf.h"

namespace weir {

std::vector<AxisPlace> axis_places(hid_t file, const Hdf5Object& object, std::span<const std::int64_t> extents) {
  std::vector<AxisPlace> axes;
  for (const std::int64_t extent : extents) axes.push_back({extent, {}, {}, {}, {}});
  const std::vector<Hdf5Handle> groups = enclosing_groups(file, object.name);
  place_by_openpmd(object.handle.get(), groups, axes);
  place_by_scales(object.handle.get(), axes);
  count_unwritten_times(object, groups, axes);
  const std::size_t of_space = axes.size() - (component_axis(axes).found() ? 1 : 0);
  place_by_vtk_hdf(object, groups, std::span(axes).first(of_space));
  place_by_attributes(object.handle.get(), groups, std::span(axes).first(of_space));
  return axes;
}

}  // namespace weir
