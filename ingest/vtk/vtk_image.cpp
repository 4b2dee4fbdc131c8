#include "ingest/vtk/vtk_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

AxisPlacement placement(const VtkImage& image, bool cells, const std::string& path) {
  std::array<Vector3, 3> steps{};
  Vector3 zero = image.origin;
  const std::array<std::int64_t, 3> points{image.points.x, image.points.y, image.points.z};
  bool valid = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      steps[axis][c] = image.direction[3 * c + axis] * image.spacing[axis];
      square += steps[axis][c] * steps[axis][c];
      // The cells of a flat image lie in its plane.
      if (cells && points[axis] > 1) zero[c] += 0.5 * steps[axis][c];
    }
    valid = valid && std::isfinite(square) && square > 0;
  }
  valid = valid && std::all_of(zero.begin(), zero.end(), [](double c) { return std::isfinite(c); });
  if (!valid) {
    throw Error(ErrorKind::input,
                cat(path, ": spacing ", image.spacing[0], ' ', image.spacing[1], ' ', image.spacing[2], " and origin ",
                    image.origin[0], ' ', image.origin[1], ' ', image.origin[2],
                    ", with the direction, are no place: each must be finite, the "
                    "spacing not 0"));
  }
  return place_axes(steps, zero, image.first);
}

}  // namespace

Index3 vtk_extent(const VtkImage& image, bool cells) {
  const auto along = [cells](std::int64_t points) { return cells && points > 1 ? points - 1 : points; };
  return {along(image.points.x), along(image.points.y), along(image.points.z)};
}

void place_vtk_image(const VtkImage& image, bool cells, SourceInfo& info) {
  const AxisPlacement placed = placement(image, cells, info.path);
  info.extent = vtk_extent(image, cells);
  info.index_origin = image.first;
  info.spacing = placed.spacing;
  info.origin = placed.origin;
  info.details.orientation = placed.orientation;
}

void describe_vtk_image(const VtkImage& image, bool cells, const std::string& path, DatasetInfo& info) {
  const AxisPlacement placed = placement(image, cells, path);
  const Index3 extent = vtk_extent(image, cells);
  info.extents = {extent.x, extent.y, extent.z};
  if (image.first != Index3{}) {
    info.attributes.emplace_back("index origin", cat(image.first.x, ',', image.first.y, ',', image.first.z));
  }
  info.attributes.emplace_back("spacing", vector_text(placed.spacing));
  info.attributes.emplace_back("origin", vector_text(placed.origin));
  if (!placed.orientation.empty()) info.attributes.emplace_back("orientation", placed.orientation);
  info.attributes.emplace_back("values of", cells ? "cells" : "points");
}

}  // namespace weir
