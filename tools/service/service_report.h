// Formats the service's JSON answers for a terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace weir {

/// Returns a duration as "4.1 s", "62 s", "7 min", "2 h" or "3 days".
std::string duration_text(double seconds);

/// Returns the jobs of GET /api/jobs as a table, one line each, with the reason below if there is one. `now` is a Unix
/// time.
std::string jobs_text(const nlohmann::ordered_json& page, double now);

/// Returns GET /api/status as text, one line per fact.
std::string status_text(const nlohmann::ordered_json& status, double now);

}  // namespace weir
