// weir resume: tells a paused `weir watch` to start jobs again.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "format/base/printable.h"
#include "format/base/text.h"
#include "tools/command.h"
#include "tools/service/service_client.h"

namespace weir {
namespace {

struct ResumeArguments {
  ServiceOptions service;
  bool json = false;
};

// Full disks also hold jobs: all jobs, or those that write to these disks.
std::string resume_text(const ServiceClient::Json& status) {
  const std::string held = printable(status.at("reason").get<std::string>());
  if (status.at("state") == "paused" && !held.empty()) return cat("resumed, but nothing starts yet: ", held, '\n');
  const auto waiting = status.at("jobs").at("waiting").get<std::uint64_t>();
  return cat("resumed: ", waiting, waiting == 1 ? " job waits" : " jobs wait",
             held.empty() ? "" : cat("; those that write to a full disk do not start yet: ", held), '\n');
}

void run(const ResumeArguments& a) {
  const ServiceClient client(a.service);
  std::cout << client.read(client.post("/api/resume"), [&](const ServiceClient::Json& status) {
    return a.json ? status.dump() + '\n' : resume_text(status);
  });
}

}  // namespace

void add_resume(CLI::App& app) {
  CLI::App* command = app.add_subcommand("resume", "Has a paused weir watch start jobs again");
  const auto a = std::make_shared<ResumeArguments>();
  command->add_flag("--json", a->json, "the service's status, one JSON object on stdout");
  add_service_options(*command, a->service);
  add_log_level(*command);
  command->callback([a] { run(*a); });
}

}  // namespace weir
