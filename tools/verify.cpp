// weir verify: everything a volume and its sidecar say about each other and
// themselves, checked. Exit 0 only if all holds.
#include <tbb/parallel_for.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "format/digest.h"
#include "format/error.h"
#include "format/nvdb_file.h"
#include "format/sidecar.h"
#include "format/text.h"
#include "tools/command.h"
#include "tools/progress.h"
#include "tools/read_sidecar.h"
#include "tools/volume_check.h"

namespace weir {
namespace {

struct VerifyArguments {
  std::string path;
  bool json = false;
  ProgressOptions progress;
};

void stop_if_interrupted() {
  if (interrupt_flag()) throw Error(ErrorKind::interrupted, "interrupted");
}

std::string parallel_digest(std::span<const std::byte> file, Progress& progress) {
  constexpr std::uint64_t kBatch = 32;  // pieces between two looks at the progress and the interrupt flag
  progress.start("digest", file.size());
  std::vector<Digest> pieces(piece_count(file.size()));
  for (std::uint64_t begin = 0; begin < pieces.size(); begin += kBatch) {
    const std::uint64_t end = std::min<std::uint64_t>(begin + kBatch, pieces.size());
    tbb::parallel_for(begin, end, [&](std::uint64_t i) { pieces[i] = piece_digest(file_piece(file, i)); });
    progress.update(end * kDigestPieceBytes);
    stop_if_interrupted();
  }
  return combine(pieces).hex();
}

// Failures that end the verification early become a check like any other.
template <typename Run>
auto checked(const std::string& name, std::vector<VolumeCheck>& checks, const Run& run)
    -> std::optional<decltype(run())> {
  try {
    return run();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    checks.push_back({name, error.what(), "", false});
    return std::nullopt;
  }
}

std::vector<VolumeCheck> verify(const VerifyArguments& arguments) {
  std::vector<VolumeCheck> checks;
  Progress progress(arguments.progress);
  const auto sidecar = checked("sidecar", checks, [&] { return read_sidecar(sidecar_path(arguments.path)); });
  const auto file = checked("structure", checks, [&] { return std::make_unique<NvdbFile>(arguments.path); });
  if (!file) return checks;
  const NvdbGrid& grid = (*file)->grid();
  const std::uint64_t leaves = std::max<std::uint64_t>(grid.node_counts()[0], 1);
  progress.start("leaves", grid.data_bytes());
  const auto census = checked("structure", checks, [&] {
    return take_census(grid, [&](std::uint64_t done) {
      progress.update(static_cast<std::uint64_t>(static_cast<double>(grid.data_bytes()) * static_cast<double>(done) /
                                                 static_cast<double>(leaves)));
      stop_if_interrupted();
    });
  });
  if (!census) return checks;
  checks.push_back({"structure", "valid", "a valid NanoVDB file", true});
  for (VolumeCheck& check : check_structure(grid, *census)) checks.push_back(std::move(check));
  if (!sidecar) return checks;
  const std::string digest = parallel_digest(grid.bytes(), progress);
  for (VolumeCheck& check : check_sidecar(grid, *census, digest, *sidecar)) checks.push_back(std::move(check));
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
  add_progress_options(*command, arguments->progress);
  add_log_level(*command);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace weir
