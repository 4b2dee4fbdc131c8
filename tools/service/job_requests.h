// Sends one request for several jobs of a running `weir watch`, one job after the other.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "tools/service/service_client.h"

namespace weir {

struct JobRequests {
  std::span<const std::int64_t> ids;
  std::string action;  ///< the ACTION in POST /api/jobs/ID/ACTION
  std::function<std::string(const ServiceClient::Json& job)> text;
  bool json = false;
};

/// Adds the positional option "id": jobs, as `weir jobs` lists them. Other texts than whole numbers from 1 on are
/// refused.
CLI::Option* add_job_ids(CLI::App& command, std::vector<std::int64_t>& ids);

/// Prints the result for each job on stdout: its `text`, or with `json` one object {"jobs": [...]}. If the service
/// refuses a job, the other jobs are still sent; then an Error with all refusals is thrown.
void ask_of_jobs(const ServiceClient& client, const JobRequests& requests);

}  // namespace weir
