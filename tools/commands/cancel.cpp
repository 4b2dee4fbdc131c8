// weir cancel: tells a running `weir watch` to cancel jobs.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/base/printable.h"
#include "format/base/text.h"
#include "tools/command.h"
#include "tools/service/job_requests.h"
#include "tools/service/service_client.h"

namespace weir {
namespace {

struct CancelArguments {
  ServiceOptions service;
  std::vector<std::int64_t> ids;
  bool json = false;
};

// For a job that is done, only its thumbnail is cancelled.
std::string cancelled_text(const ServiceClient::Json& job) {
  return cat("job ", job.at("id").get<std::int64_t>(),
             job.at("state") == "done" ? " is done, and goes without a thumbnail: " : " is cancelled: ",
             printable(job.at("source")), '\n');
}

void run(const CancelArguments& a) {
  ask_of_jobs(ServiceClient(a.service), {.ids = a.ids, .action = "cancel", .text = cancelled_text, .json = a.json});
}

}  // namespace

void add_cancel(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "cancel", "Has a running weir watch give jobs up, and remove what they had begun; weir retry begins them anew");
  const auto a = std::make_shared<CancelArguments>();
  add_job_ids(*command, a->ids)->required();
  command->add_flag("--json", a->json, "one JSON object on stdout");
  add_service_options(*command, a->service);
  add_log_level(*command);
  command->callback([a] { run(*a); });
}

}  // namespace weir
