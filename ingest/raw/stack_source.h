// One volume from many files. Each file is a slab of the volume along z.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Opens one volume. open_source (source_registry.h) is such a function.
using OpenVolume = std::function<std::unique_ptr<VolumeSource>(const std::string& path, const SourceOptions& options)>;

/// Stacks the files that `pattern` names ('plane_%05d.raw') along z, by rising number. `open` opens each file with
/// `options`, without spacing, origin and roi, which apply to the stack. Files are open only while they are read, a
/// few at a time. Throws Error(input) naming the file if a number between two others is missing, or if extent in x
/// and y, type, scale or missing values differ from the first file's. Also throws what opening a file throws.
std::unique_ptr<VolumeSource> open_stack(const std::string& pattern, const SourceOptions& options, OpenVolume open);

}  // namespace weir
