// AMReX plotfiles: directories that hold the components of a simulation on levels of refined boxes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns whether `head`, the first bytes of a Header, is a plotfile's. `path` is the plotfile's directory or its
/// Header.
bool recognises_amrex(std::string_view path, std::span<const std::byte> head);

/// Opens the component options.dataset, or the only one, as one grid of cells of options.level, or of the finest
/// level. Voxel (0, 0, 0) is the domain's first cell at this level. With Levels::separate, opens the level
/// options.own_level alone: the bounds of its boxes, without values where finer levels, up to options.level, have
/// cells and where it has no box. Throws Error(usage) if several components or levels can be converted and none is
/// named, or if the level does not exist. Also throws the errors of open_plotfile.
std::unique_ptr<VolumeSource> open_amrex(const std::string& path, const SourceOptions& options);
/// Returns the number of levels from the coarsest to options.level, or to the finest. Reads only the Header.
std::int64_t count_amrex_levels(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_amrex(const std::string& path, const SourceOptions& options);

/// Returns, in words, what the program that writes the plotfile of this Header still has to write; empty if all is
/// there: the Header, each level's Cell_H, and all FABs that it names. Checks the files of FABs, but not their
/// values. Also returns an empty text if later writing cannot make the plotfile readable: a 2-D plotfile, cylindrical
/// coordinates, ghost cells.
std::string unwritten_part(const std::string& header_path);

}  // namespace weir
