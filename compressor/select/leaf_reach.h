// The reach of a leaf: the interval of values that a filtered lookup can give if it touches one of the leaf's voxels.
// The reach decides whether anything of the leaf can be seen.
#pragma once

#include <cstdint>

#include "compressor/leaf/fill.h"
#include "compressor/resume/work_directory.h"
#include "compressor/survey/leaf_faces.h"
#include "compressor/survey/row_store.h"
#include "compressor/survey/visibility.h"
#include "ingest/source/cell_places.h"

namespace weir {

/// How much of a volume a scene shows.
struct Shown {
  std::uint64_t blocks = 0;  ///< leaves that can be seen, at least in part
  std::uint64_t finite = 0;  ///< finite voxels in them
};

/// Gives `rows` the reach of every leaf, in one pass over rows and faces. The reach covers the leaf's values, the
/// values next to it, and the background if it replaces a value that is not finite. It is empty outside the scene's
/// region. `places` is null, or the places of a sample's cells: leaves then lie where they do in the sampled volume. If
/// the neighbour of a cell is not known, the cell's values are extrapolated by one layer.
Shown find_reaches(const LeafStore<LeafFaces>& faces, const Visibility& visibility, const Fill& fill,
                   const CellPlaces* places, WorkDirectory& work, RowStore& rows);

}  // namespace weir
