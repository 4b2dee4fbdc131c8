// Whether the outputs of a job, by their certificates, stand for its source.
#pragma once

#include <optional>
#include <string>

#include "daemon/store/job.h"
#include "ingest/files/file_state.h"

namespace weir {

/// Why the outputs do not stand for the source, of which `state` is now; empty: they do. Without `state`, which a
/// rename changes, the source may be older or younger than its certificate.
std::string outputs_fault(const Job& job, const std::optional<FileState>& state);

}  // namespace weir
