// weir retry: tells a running `weir watch` to try jobs again.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "format/base/error.h"
#include "format/base/printable.h"
#include "format/base/text.h"
#include "tools/command.h"
#include "tools/service/job_requests.h"
#include "tools/service/service_client.h"

namespace weir {
namespace {

using Json = ServiceClient::Json;

struct RetryArguments {
  ServiceOptions service;
  std::vector<std::int64_t> ids;
  bool all_failed = false;
  bool force = false;
  bool json = false;
};

void retry_all(const RetryArguments& a) {
  const ServiceClient client(a.service);
  std::cout << client.read(client.post("/api/retry-failed"), [&](const Json& answer) {
    const auto retried = answer.at("retried").get<std::uint64_t>();
    return a.json ? answer.dump() + '\n' : cat(retried, retried == 1 ? " job is" : " jobs are", " tried again\n");
  });
}

std::string retried_text(const Json& job) {
  return cat("job ", job.at("id").get<std::int64_t>(), " is tried again: ", printable(job.at("source")), '\n');
}

void run(const RetryArguments& a) {
  if (!a.ids.empty() && a.all_failed) throw usage_error("give IDs or --all-failed, not both");
  if (a.ids.empty() && !a.all_failed) {
    throw Error(ErrorKind::usage, "give the IDs of the jobs to try again, as weir jobs lists them, or --all-failed");
  }
  if (a.all_failed && a.force) throw Error(ErrorKind::usage, "--force is for jobs given by their IDs");
  if (a.all_failed) return retry_all(a);
  ask_of_jobs(ServiceClient(a.service),
              {.ids = a.ids, .action = a.force ? "retry?force=1" : "retry", .text = retried_text, .json = a.json});
}

}  // namespace

void add_retry(CLI::App& app) {
  CLI::App* command = app.add_subcommand("retry", "Has a running weir watch try jobs again");
  const auto a = std::make_shared<RetryArguments>();
  add_job_ids(*command, a->ids);
  command->add_flag("--all-failed", a->all_failed, "every failed and quarantined one");
  command->add_flag("--force", a->force, "of jobs given by ID: convert them even where their outputs are done");
  command->add_flag("--json", a->json, "one JSON object on stdout");
  add_service_options(*command, a->service);
  add_log_level(*command);
  command->callback([a] { run(*a); });
}

}  // namespace weir
