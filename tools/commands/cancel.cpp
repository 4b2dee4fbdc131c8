// weir cancel: has a running `weir watch` give jobs up.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/printable.h"
#include "format/base/text.h"
#include "tools/command.h"
#include "tools/service/service_client.h"

namespace weir {
namespace {

struct CancelArguments {
  ServiceOptions service;
  std::vector<std::int64_t> ids;
  bool json = false;
};

// A done job is asked for its thumbnail only.
std::string cancelled_text(const ServiceClient::Json& job) {
  return cat("job ", job.at("id").get<std::int64_t>(),
             job.at("state") == "done" ? " is done, and goes without a thumbnail: " : " is cancelled: ",
             printable(job.at("source")), '\n');
}

void run(const CancelArguments& a) {
  const ServiceClient client(a.service);
  ServiceClient::Json jobs = ServiceClient::Json::array();
  std::optional<Error> refused;  // the others are cancelled all the same
  for (const std::int64_t id : a.ids) {
    try {
      jobs.push_back(client.post(cat("/api/jobs/", id, "/cancel")));
    } catch (const Error& error) {
      refused = refused ? Error(refused->kind(), cat(refused->what(), "; ", error.what())) : error;
      continue;
    }
    if (!a.json) std::cout << client.read(jobs.back(), cancelled_text);
  }
  if (a.json) std::cout << ServiceClient::Json{{"jobs", jobs}}.dump() << '\n';
  if (refused) throw *refused;
}

}  // namespace

void add_cancel(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "cancel", "Has a running weir watch give jobs up, and remove what they had begun; weir retry begins them anew");
  const auto a = std::make_shared<CancelArguments>();
  command->add_option("id", a->ids, "jobs, as weir jobs lists them")->required();
  command->add_flag("--json", a->json, "one JSON object on stdout");
  add_service_options(*command, a->service);
  add_log_level(*command);
  command->callback([a] { run(*a); });
}

}  // namespace weir
