#include "tools/service/job_requests.h"

#include <iostream>
#include <limits>
#include <optional>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// Checks the number here, because the parser takes the nearest number that it can hold for one out of range. Texts that
// are no number are left to the parser.
std::string is_job_id(const std::string& text) {
  const std::string_view digits = std::string_view(text).substr(text.starts_with('-') ? 1 : 0);
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string_view::npos) return {};
  if (const auto id = parse_int(text); id && *id > 0) return {};
  throw usage_error(
      cat("id is \"", text, "\", it must be a number from 1 to ", std::numeric_limits<std::int64_t>::max()));
}

}  // namespace

CLI::Option* add_job_ids(CLI::App& command, std::vector<std::int64_t>& ids) {
  return command.add_option("id", ids, "jobs, as weir jobs lists them")->check(is_job_id);
}

void ask_of_jobs(const ServiceClient& client, const JobRequests& requests) {
  ServiceClient::Json jobs = ServiceClient::Json::array();
  std::optional<Error> refused;
  for (const std::int64_t id : requests.ids) {
    try {
      jobs.push_back(client.post(cat("/api/jobs/", id, '/', requests.action)));
      if (!requests.json) std::cout << client.read(jobs.back(), requests.text);
    } catch (const Error& error) {
      if (!refused) {
        refused = error;
      } else if (std::string_view(refused->what()) != error.what()) {
        refused = Error(refused->kind(), cat(refused->what(), "; ", error.what()));
      }
      if (error.kind() != ErrorKind::usage) break;  // not a refusal of this job: the service does not answer
    }
  }
  if (requests.json) std::cout << ServiceClient::Json{{"jobs", jobs}}.dump() << '\n';
  if (refused) throw *refused;
}

}  // namespace weir
