// weir verify: everything a volume and its sidecar say about each other and
// themselves, checked. Exit 0 only if all holds.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/sidecar/sidecar.h"
#include "tools/command.h"
#include "tools/options/run_options.h"
#include "tools/options/trace_option.h"
#include "tools/report/progress.h"
#include "tools/report/volume_verification.h"

namespace weir {
namespace {

struct VerifyArguments {
  std::string path;
  bool json = false;
  std::string trace;
  ProgressOptions progress;
};

std::vector<VolumeCheck> verify(const VerifyArguments& arguments) {
  const auto threads = limit_threads(0);
  Progress progress(arguments.progress);
  VerificationWatch watch;
  watch.pass_started = [&](const std::string& pass, std::uint64_t bytes) { progress.start(pass, bytes); };
  watch.pass_advanced = [&](std::uint64_t done) { progress.update(done); };
  watch.cancel = &interrupt_flag();
  const std::unique_ptr<Trace> trace =
      open_trace(arguments.trace, std::array{arguments.path, sidecar_path(arguments.path)});
  watch.trace = trace.get();
  std::vector<VolumeCheck> checks = verify_volume(arguments.path, watch);
  if (trace) trace->close();
  return checks;
}

// An error of a reader says already where and what was expected.
std::string failure_text(const std::string& path, const VolumeCheck& check) {
  if (check.expected.empty()) return cat(check.name, ": ", check.found);
  return cat(path, ": ", check.name, ": found ", check.found, ", expected ", check.expected);
}

void print_json(const std::string& path, bool ok, const std::vector<VolumeCheck>& checks) {
  nlohmann::ordered_json report{{"path", path}, {"ok", ok}, {"checks", nlohmann::ordered_json::array()}};
  for (const VolumeCheck& check : checks) {
    report["checks"].push_back(
        {{"name", check.name}, {"ok", check.ok}, {"found", check.found}, {"expected", check.expected}});
  }
  std::cout << report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

void run(const VerifyArguments& arguments) {
  const std::vector<VolumeCheck> checks = verify(arguments);
  std::size_t failed = 0;
  for (const VolumeCheck& check : checks) {
    if (check.ok) continue;
    ++failed;
    std::fprintf(stderr, "weir: %s\n", failure_text(arguments.path, check).c_str());
  }
  if (arguments.json) print_json(arguments.path, failed == 0, checks);
  if (failed != 0) throw ExitStatus{static_cast<int>(ErrorKind::input)};
  if (!arguments.json) std::cout << arguments.path << ": all " << checks.size() << " checks hold\n";
}

}  // namespace

void add_verify(CLI::App& app) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* command = app.add_subcommand("verify", "Checks structure, checksum, digest and sidecar of a volume");
  command->add_option("volume", arguments->path, "the .nvdb file; its sidecar lies beside it")
      ->type_name("OUT.nvdb")
      ->required();
  command->add_flag("--json", arguments->json, "one JSON object on stdout");
  add_trace_option(*command, arguments->trace);
  add_progress_options(*command, arguments->progress);
  add_log_level(*command);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace weir
