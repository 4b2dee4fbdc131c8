#include "tools/service/job_requests.h"

#include <iostream>
#include <optional>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

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
