// weir status: shows the state of a running `weir watch`.
#include <CLI/CLI.hpp>
#include <ctime>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/command.h"
#include "tools/service/service_client.h"
#include "tools/service/service_report.h"

namespace weir {
namespace {

struct StatusArguments {
  ServiceOptions service;
  bool json = false;
};

void run(const StatusArguments& a) {
  const ServiceClient client(a.service);
  const auto now = static_cast<double>(std::time(nullptr));
  std::cout << client.read(client.get("/api/status"), [&](const ServiceClient::Json& status) {
    return a.json ? status.dump() + '\n' : status_text(status, now);
  });
}

}  // namespace

void add_status(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("status", "Shows how a running weir watch is: its jobs, throughput and watches");
  const auto a = std::make_shared<StatusArguments>();
  command->add_flag("--json", a->json, "one JSON object on stdout");
  add_service_options(*command, a->service);
  add_log_level(*command);
  command->callback([a] { run(*a); });
}

}  // namespace weir
