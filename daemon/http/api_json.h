// The views of control.h as the JSON that the API sends. Keys are the members'
// names; a value that is not known is null; times are Unix seconds.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "daemon/http/control.h"

namespace weir {

using OrderedJson = nlohmann::ordered_json;

OrderedJson to_json(const JobView& job);  ///< log_tail only where there is one
OrderedJson to_json(const JobPage& page, const JobQuery& query);
OrderedJson to_json(const ProblemPage& page);  ///< a problem's reason without its source's path
OrderedJson to_json(const StatusView& status);
OrderedJson to_json(const ViewerView& viewer);

/// One line; bytes that are not UTF-8 (a path may hold any) become U+FFFD.
std::string json_line(const OrderedJson& json);

}  // namespace weir
