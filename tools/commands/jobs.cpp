// weir jobs: what a running `weir watch` knows of its sources.
#include <CLI/CLI.hpp>
#include <ctime>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/http/request_target.h"
#include "daemon/store/job_state.h"
#include "format/base/text.h"
#include "tools/command.h"
#include "tools/service/service_client.h"
#include "tools/service/service_report.h"

namespace weir {
namespace {

struct JobsArguments {
  ServiceOptions service;
  std::string state;
  std::string watch;
  int limit = 100;
  std::int64_t offset = 0;
  bool json = false;
};

void run(const JobsArguments& a) {
  std::string target = cat("/api/jobs?limit=", a.limit, "&offset=", a.offset);
  if (!a.state.empty()) target += cat("&state=", percent_encode(a.state));
  if (!a.watch.empty()) target += cat("&watch=", percent_encode(a.watch));
  const ServiceClient client(a.service);
  const auto now = static_cast<double>(std::time(nullptr));
  std::cout << client.read(client.get(target), [&](const ServiceClient::Json& page) {
    return a.json ? page.dump() + '\n' : jobs_text(page, now);
  });
}

}  // namespace

void add_jobs(CLI::App& app) {
  CLI::App* command = app.add_subcommand("jobs", "Lists the jobs of a running weir watch, the latest change first");
  const auto a = std::make_shared<JobsArguments>();
  command->add_option("--state", a->state, "only those in this state")
      ->check(CLI::IsMember(std::vector<std::string>(kJobStateNames.begin(), kJobStateNames.end())));
  command->add_option("--watch", a->watch, "only those of this watch, as weir status names it");
  command->add_option("--limit", a->limit, "at most so many")->check(CLI::Range(1, 1000))->capture_default_str();
  command->add_option("--offset", a->offset, "without the first ones")->check(CLI::NonNegativeNumber);
  command->add_flag("--json", a->json, "one JSON object on stdout");
  add_service_options(*command, a->service);
  add_log_level(*command);
  command->callback([a] { run(*a); });
}

}  // namespace weir
