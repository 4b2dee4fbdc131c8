// weir verify: checks what a volume and its sidecar say about themselves and each other. Exits with 0 only if all
// checks pass.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/printable.h"
#include "format/base/text.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/sidecar.h"
#include "tools/command.h"
#include "tools/options/command_message.h"
#include "tools/options/run_options.h"
#include "tools/options/trace_option.h"
#include "tools/options/volume_series.h"
#include "tools/report/error_line.h"
#include "tools/report/progress.h"
#include "tools/verify/volume_verification.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

struct VerifyArguments {
  std::vector<std::string> paths;
  bool json = false;
  std::string trace;
  ProgressOptions progress;
};

std::vector<VolumeCheck> verify(const std::string& path, const VerifyArguments& arguments) {
  const auto threads = limit_threads(0);
  Progress progress(arguments.progress);
  VerificationWatch watch;
  watch.pass_started = [&](const std::string& pass, std::uint64_t bytes) { progress.start(pass, bytes); };
  watch.pass_advanced = [&](std::uint64_t done) { progress.update(done); };
  watch.cancel = &interrupt_flag();
  const std::unique_ptr<Trace> trace = open_trace(arguments.trace, std::array{path, find_sidecar(path)});
  watch.trace = trace.get();
  std::vector<VolumeCheck> checks = verify_volume(path, watch);
  if (trace) trace->close();
  return checks;
}

// Returns the text of a failed check. A reader's error already says where it is and what was expected.
std::string failure_text(const std::string& path, const VolumeCheck& check) {
  if (check.expected.empty()) return cat(check.name, ": ", check.found);
  return cat(path, ": ", check.name, ": found ", check.found, ", expected ", check.expected);
}

Json to_json(const std::string& path, bool ok, const std::vector<VolumeCheck>& checks) {
  Json report{{"path", path}, {"ok", ok}, {"checks", Json::array()}};
  for (const VolumeCheck& check : checks) {
    report["checks"].push_back(
        {{"name", check.name}, {"ok", check.ok}, {"found", check.found}, {"expected", check.expected}});
  }
  return report;
}

// Verifies one volume and returns its checks. Failures go to stderr and raise `status` from 0 to their exit code. An
// unreadable file is not called damaged, because it may be sound.
Json verify_one(const CLI::App& app, const std::string& path, const VerifyArguments& arguments, int& status) {
  const auto raise = [&](ErrorKind kind) { status = status == 0 ? static_cast<int>(kind) : status; };
  std::error_code why;
  if (std::filesystem::status(path, why).type() == std::filesystem::file_type::not_found) {
    const Error missing = io_error(path, "open", why.value());
    print_error_line(command_message(app, missing));
    raise(ErrorKind::input);
    return to_json(path, false, {{"structure", missing.what(), "", false}});
  }
  std::vector<VolumeCheck> checks;
  try {
    checks = verify(path, arguments);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::io) throw;
    print_error_line(error.what());
    raise(ErrorKind::io);
    return to_json(path, false, {{"readable", error.what(), "", false}});
  }
  bool ok = true;
  for (const VolumeCheck& check : checks) {
    if (check.ok) continue;
    ok = false;
    print_error_line(failure_text(path, check));
  }
  if (!ok) raise(ErrorKind::input);
  if (ok && !arguments.json) std::cout << cat(one_line(path), ": all ", checks.size(), " checks hold\n");
  return to_json(path, ok, checks);
}

void run(const CLI::App& app, const VerifyArguments& arguments) {
  const std::vector<std::string> paths = expand_volumes(arguments.paths);
  if (paths.size() > 1 && !arguments.trace.empty()) {
    throw usage_error(cat("--trace is of one volume, and ", paths.size(), " are given"));
  }
  Json volumes = Json::array();
  int status = 0;
  for (const std::string& path : paths) volumes.push_back(verify_one(app, path, arguments, status));
  if (arguments.json) {
    const Json report = volumes.size() == 1 ? volumes.front() : Json{{"ok", status == 0}, {"volumes", volumes}};
    std::cout << json_text(report) << '\n';
  }
  if (status != 0) throw ExitStatus{status};
}

}  // namespace

void add_verify(CLI::App& app) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* command = app.add_subcommand("verify", "Checks structure, checksum, digest and sidecar of a volume");
  command
      ->add_option("volume", arguments->paths,
                   "the .nvdb file, its sidecar beside it; or several, or patterns in quotes, 'out/*.nvdb' or "
                   "'step_%04d.nvdb'")
      ->type_name("OUT.nvdb")
      ->required();
  command->add_flag("--json", arguments->json, "one JSON object on stdout");
  add_trace_option(*command, arguments->trace);
  add_progress_options(*command, arguments->progress);
  add_log_level(*command);
  command->callback([&app, arguments] { run(app, *arguments); });
}

}  // namespace weir
