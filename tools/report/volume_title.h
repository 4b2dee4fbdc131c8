// What a volume is called where people read it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "format/sidecar/sidecar.h"

namespace weir {

/// What was chosen of an input: "/qc at 2,1, component x", or "/v, magnitude"; empty for a file that is one volume.
/// `component` as the sidecar has it.
std::string chosen_text(const std::string& dataset, std::span<const std::int64_t> index, const std::string& component);

/// The file's name without its folders, and what was chosen of it: "run.h5 /qc at 2".
std::string volume_title(const Sidecar::Source& source);

}  // namespace weir
