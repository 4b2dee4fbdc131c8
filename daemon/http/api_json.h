// The views of control.h as the JSON of the API. Keys are the members' names; an unknown value is null; times are
// Unix seconds.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "daemon/http/control.h"

namespace weir {

using OrderedJson = nlohmann::ordered_json;

OrderedJson to_json(const JobView& job);  ///< log_tail is left out if it is empty
OrderedJson to_json(const JobPage& page, const JobQuery& query);
OrderedJson to_json(const ProblemPage& page);  ///< the reason of a problem comes without its source's path
OrderedJson to_json(const StatusView& status);
OrderedJson to_json(const ViewerView& viewer);

/// Returns the JSON as one line. Bytes that are not UTF-8 (a path may hold any bytes) become U+FFFD.
std::string json_line(const OrderedJson& json);

}  // namespace weir
