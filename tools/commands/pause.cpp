// weir pause: tells a running `weir watch` to start no more jobs.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "format/base/text.h"
#include "tools/command.h"
#include "tools/service/service_client.h"

namespace weir {
namespace {

struct PauseArguments {
  ServiceOptions service;
  bool json = false;
};

std::string pause_text(const ServiceClient::Json& status) {
  const ServiceClient::Json& all = status.at("running");
  const auto running = std::ranges::count_if(all, [](const auto& job) { return job.at("step") != "render"; });
  return cat("paused: nothing starts until weir resume, and ", running, running == 1 ? " job goes" : " jobs go",
             " on to the end\n");
}

void run(const PauseArguments& a) {
  const ServiceClient client(a.service);
  std::cout << client.read(client.post("/api/pause"), [&](const ServiceClient::Json& status) {
    return a.json ? status.dump() + '\n' : pause_text(status);
  });
}

}  // namespace

void add_pause(CLI::App& app) {
  CLI::App* command = app.add_subcommand("pause", "Has a running weir watch start no more jobs; those that run go on");
  const auto a = std::make_shared<PauseArguments>();
  command->add_flag("--json", a->json, "the service's status, one JSON object on stdout");
  add_service_options(*command, a->service);
  add_log_level(*command);
  command->callback([a] { run(*a); });
}

}  // namespace weir
