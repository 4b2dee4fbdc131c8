// Checks by their certificates whether the outputs of a job are those of its source.
#pragma once

#include <optional>
#include <string>

#include "daemon/store/job.h"
#include "ingest/files/file_state.h"

namespace weir {

/// Returns why the outputs do not represent the source in its present `state`; empty if they do. Without `state` (a
/// rename changes it), the function does not compare the ages of the source and its certificate.
std::string outputs_fault(const Job& job, const std::optional<FileState>& state);

}  // namespace weir
