// The reach of a leaf: the interval of values that a filtered lookup that touches one of its voxels can give. The reach
// decides whether anything of the leaf can be seen.
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
  std::uint64_t blocks = 0;  ///< leaves of which something can be seen
  std::uint64_t finite = 0;  ///< finite voxels in them
};

/// Gives `rows` the reach of every leaf: its values, those next to it, and the background where it takes the place of
/// a value that is not finite; empty outside the scene's region. One pass over rows and faces. `places`,
/// which may be null, is that of a sample: leaves then lie where they do in the sampled volume. Where what lies beside
/// a cell is not known, the cell's values are extrapolated by one layer.
Shown find_reaches(const LeafStore<LeafFaces>& faces, const Visibility& visibility, const Fill& fill,
                   const CellPlaces* places, WorkDirectory& work, RowStore& rows);

}  // namespace weir
