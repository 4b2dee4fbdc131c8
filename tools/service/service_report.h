// The service's JSON answers as text for a terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace weir {

/// "4.1 s", "62 s", "7 min", "2 h", "3 days".
std::string duration_text(double seconds);

/// A table of GET /api/jobs, a line each, its reason below where there is one. `now` is a Unix time.
std::string jobs_text(const nlohmann::ordered_json& page, double now);

/// GET /api/status, a line a fact.
std::string status_text(const nlohmann::ordered_json& status, double now);

}  // namespace weir
