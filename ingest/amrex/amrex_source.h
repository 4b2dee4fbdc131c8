// AMReX plotfiles: directories, of which each holds the components of a simulation on levels of refined boxes.
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

/// By the first bytes of its Header; `path` is the directory's, or that of the Header.
bool recognises_amrex(std::string_view path, std::span<const std::byte> head);

/// The component options.dataset, or the only one, as one grid of the cells of options.level, or of the finest level.
/// Voxel (0, 0, 0) is the domain's first cell there. Of Levels::separate the level options.own_level: the box of its
/// boxes, without values where finer levels, up to options.level, have cells and where it has none. Throws Error(usage)
/// where several components or levels can be converted and none is named; where there is no such level; and what
/// open_plotfile throws.
std::unique_ptr<VolumeSource> open_amrex(const std::string& path, const SourceOptions& options);
/// Levels from the coarsest to options.level, or the finest. Reads the Header alone.
std::int64_t count_amrex_levels(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_amrex(const std::string& path, const SourceOptions& options);

/// What a program that writes the plotfile of this Header has still to write, in words; empty where all is there:
/// the Header, each level's Cell_H and all FABs that it names. The files of FABs are looked at, their values are not.
/// Empty, too, where nothing that is written later makes it readable: a 2-D plotfile, cylindrical coordinates, ghost
/// cells.
std::string unwritten_part(const std::string& header_path);

}  // namespace weir
