// Names a volume for people.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "format/sidecar/sidecar.h"

namespace weir {

/// Returns what was chosen of an input: "/qc at 2,1, component x", or "/v, magnitude"; empty for a file that is one
/// volume. `component` is the sidecar's text.
std::string chosen_text(const std::string& dataset, std::span<const std::int64_t> index, const std::string& component);

/// Returns the file's name without its folders, and what was chosen of the file: "run.h5 /qc at 2".
std::string volume_title(const Sidecar::Source& source);

}  // namespace weir
