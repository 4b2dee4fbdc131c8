// What is asked of several jobs of a running `weir watch`, one after the other.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "tools/service/service_client.h"

namespace weir {

struct JobRequests {
  std::span<const std::int64_t> ids;
  std::string action;  ///< of POST /api/jobs/ID/ACTION
  std::function<std::string(const ServiceClient::Json& job)> text;
  bool json = false;
};

/// Says on stdout what came of each job: its `text`, or with `json` one object {"jobs": [...]}. A job that the service
/// refuses does not keep it from the others; then throws Error with what it said of all that it refused.
void ask_of_jobs(const ServiceClient& client, const JobRequests& requests);

}  // namespace weir
