// weir jobs: lists what a running `weir watch` knows of its sources.
#include <CLI/CLI.hpp>
#include <ctime>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/http/request_target.h"
#include "daemon/store/job_state.h"
#include "format/base/error.h"
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

// Throws if there is no watch `label`. A watch without jobs appears in the status; a watch that was removed from the
// configuration may still have jobs.
void require_watch(const ServiceClient& client, const std::string& label) {
  const std::string any = cat("/api/jobs?limit=1&watch=", percent_encode(label));
  const auto has_some = [](const ServiceClient::Json& page) { return page.at("total").get<std::uint64_t>() > 0; };
  if (client.read(client.get(any), has_some)) return;
  std::string labels;
  const bool known = client.read(client.get("/api/status"), [&](const ServiceClient::Json& status) {
    for (const auto& watch : status.at("watches")) {
      const auto name = watch.at("label").get<std::string>();
      if (name == label) return true;
      labels += cat(labels.empty() ? "" : ", ", name);
    }
    return false;
  });
  if (known) return;
  throw usage_error(cat("--watch is \"", label, "\", which no watch is called; there are ", labels));
}

void run(const JobsArguments& a) {
  std::string target = cat("/api/jobs?limit=", a.limit, "&offset=", a.offset);
  if (!a.state.empty()) target += cat("&state=", percent_encode(a.state));
  if (!a.watch.empty()) target += cat("&watch=", percent_encode(a.watch));
  const ServiceClient client(a.service);
  const auto now = static_cast<double>(std::time(nullptr));
  bool none = false;
  const std::string text = client.read(client.get(target), [&](const ServiceClient::Json& page) {
    none = page.at("total") == 0;
    return a.json ? page.dump() + '\n' : jobs_text(page, now);
  });
  if (none && !a.watch.empty()) require_watch(client, a.watch);
  std::cout << text;
}

}  // namespace

void add_jobs(CLI::App& app) {
  CLI::App* command = app.add_subcommand("jobs", "Lists the jobs of a running weir watch, the latest change first");
  const auto a = std::make_shared<JobsArguments>();
  command->add_option("--state", a->state, "only those in this state")
      ->check(CLI::IsMember(std::vector<std::string>(kJobStateNames.begin(), kJobStateNames.end())));
  command->add_option("--watch", a->watch, "only those of this watch, as weir status names it");
  command->add_option("--limit", a->limit, "how many are listed at most")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--offset", a->offset, "how many of the first ones are left out")->check(CLI::NonNegativeNumber);
  command->add_flag("--json", a->json, "one JSON object on stdout");
  add_service_options(*command, a->service);
  add_log_level(*command);
  command->callback([a] { run(*a); });
}

}  // namespace weir
