// The checks of `weir verify`: a volume against itself and against its sidecar.
#pragma once

#include <string>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/sidecar.h"
#include "tools/verify/tree_census.h"

namespace weir {

/// One check; `found` and `expected` are texts. If reading failed, `found` is the whole message and `expected` is
/// empty.
struct VolumeCheck {
  std::string name;
  std::string found;
  std::string expected;
  bool ok = false;
};

/// Checks the stored figures of `grid` against `census`: tree, bounding box, range, macrocells, head checksum.
std::vector<VolumeCheck> check_structure(const NvdbGrid& grid, const TreeCensus& census);

/// Checks the sidecar against the volume: size, checksum, digest, name, type, extent, transform, background, range,
/// kept leaves, macrocells. `digest` is that of the file as it is.
std::vector<VolumeCheck> check_sidecar(const NvdbGrid& grid, const TreeCensus& census, const std::string& digest,
                                       const Sidecar& sidecar);

}  // namespace weir
