// `weir-mpi convert`: one conversion, shared by all processes of an MPI job.
#include <mpi.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <span>
#include <sstream>
#include <string>

#include "bindings/mpi/agreement.h"
#include "bindings/mpi/mpi_file_system.h"
#include "bindings/mpi/mpi_team.h"
#include "compressor/build_commit.h"
#include "compressor/conversion.h"
#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/process/fault.h"
#include "ingest/source_registry.h"
#include "tools/command.h"
#include "tools/command_request.h"
#include "tools/interrupt.h"
#include "tools/options/command_message.h"
#include "tools/options/given_options.h"
#include "tools/options/parse_command_line.h"
#include "tools/options/parse_message.h"
#include "tools/options/run_options.h"
#include "tools/options/table_options.h"
#include "tools/report/error_line.h"
#include "tools/report/progress.h"
#include "tools/report/standard_output.h"

namespace {

constexpr const char* kProgram = "weir-mpi";

/// The command line as given; empty: not given.
struct Arguments {
  std::string input;
  std::string output;
  bool json = false;
  weir::GivenOptions options;
  weir::ProgressOptions progress;
};

void add_convert(CLI::App& app, Arguments& a) {
  CLI::App& command = *app.add_subcommand("convert", "Convert a volume to the file that weir convert makes of it");
  command.add_option("input", a.input, "volume file that all processes can read")->required();
  command.add_option("-o,--output", a.output, "OUT.nvdb, on a file system that all processes share")->required();
  weir::add_input_options(command, a.options);
  weir::add_method_options(command, a.options);
  weir::add_run_options(command, a.options, a.progress);
  // All processes share these two as well.
  weir::add_option(command, weir::conversion_option("work-dir"), a.options);
  weir::add_option(command, weir::conversion_option("overwrite"), a.options);
  command.add_flag("--json", a.json, "print the sidecar on stdout");
  weir::add_log_level(command);
}

// Parses on all ranks. Returns the output of --help or --version from the lowest rank that has it; empty if none has.
std::string parse(CLI::App& app, int argc, char** argv, weir::MpiTeam& team) {
  std::ostringstream asked;
  team.run([&] {
    try {
      weir::parse_command_line(app, argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) throw weir::usage_error(weir::parse_message(app, error));
      app.exit(error, asked);
    }
  });
  const std::string text = asked.str();
  const auto bytes = std::as_bytes(std::span(text));
  weir::Team::Bytes lowest(bytes.begin(), bytes.end());
  team.merge(lowest, [](weir::Team::Bytes& lower, const weir::Team::Bytes& higher) {
    if (lower.empty()) lower = higher;
  });
  return {reinterpret_cast<const char*>(lowest.data()), lowest.size()};
}

void convert(const CLI::App& command, const Arguments& a, weir::MpiTeam& team) {
  const std::size_t processors = team.own_cores();
  weir::ConversionOptions options;
  std::unique_ptr<weir::VolumeSource> source;
  weir::ConversionIdentity said;
  team.run([&] {
    weir::ConversionRequest request = weir::command_request(a.options);
    options = std::move(request.conversion);
    options.output = a.output;
    options.resume = weir::Resume::off;  // an interrupted conversion is lost, by one process as by many
    options.processors = processors;
    options.provenance = {WEIR_VERSION, weir::build_commit(), weir::given_options(command, a.options)};
    if (!team.leads()) request.source.notice = {};
    request.source.spool_directory = options.work_dir.empty() ? weir::directory_of(a.output) : options.work_dir;
    source = weir::open_source(a.input, request.source);
    said = weir::said_by_all(source->info(), options);
    said["input"] = a.input;
    if (!team.alone()) said["input with bytes of digest"] = sampled_bytes(source->info().files).hex();
  });
  weir::require_alike(team, a.input, said);
  weir::Progress progress(a.progress);
  weir::ConversionControl control;
  control.cancel = &weir::interrupt_flag();
  if (team.leads()) {
    control.pass_started = [&](const std::string& pass, std::uint64_t bytes) {
      progress.start(pass, bytes / static_cast<std::uint64_t>(team.size()));  // of this process's share
    };
    control.pass_advanced = [&](std::uint64_t done) { progress.update(done); };
    control.notice = weir::log_notice;
  }
  const std::unique_ptr<weir::FileSystem> local = weir::make_posix_file_system();
  const std::unique_ptr<weir::FileSystem> shared = weir::make_mpi_file_system(team, *local);
  const weir::Sidecar sidecar = weir::convert_volume(*source, options, control, *shared, team);
  if (!team.leads()) return;
  progress.finish();
  spdlog::info("{}: {} bytes, rate {:.4g}, by {} processes, survey {:.2f} s, encode {:.2f} s", options.output,
               sidecar.file.bytes, sidecar.budget.rate, team.size(), sidecar.timing.survey_s, sidecar.timing.encode_s);
  if (a.json) std::fputs(weir::to_json_text(sidecar).c_str(), stdout);
}

int fail(const std::string& message, int code, bool says) {
  if (says) weir::print_error_line(message, kProgram);
  return code;
}

// An Error ends all ranks; only rank 0 prints it.
int run(int argc, char** argv, int rank) {
  const bool says = rank == 0;
  CLI::App app("Converts one volume with all processes of an MPI job.", kProgram);
  app.set_version_flag("--version", WEIR_VERSION);
  Arguments arguments;
  add_convert(app, arguments);
  try {
    weir::MpiTeam team(MPI_COMM_WORLD);
    const std::string asked = parse(app, argc, argv, team);
    if (!asked.empty()) {
      if (says) std::fputs(asked.c_str(), stdout);
      return 0;
    }
    convert(*app.get_subcommands().front(), arguments, team);
    return 0;
  } catch (const weir::Error& error) {
    return fail(weir::command_message(app, error), weir::exit_code_of(error), says);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int threads = MPI_THREAD_SINGLE;
  if (MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &threads) != MPI_SUCCESS) {
    return fail("MPI could not be initialised", static_cast<int>(weir::ErrorKind::internal), true);
  }
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  weir::log_in_lines(kProgram);
  weir::catch_interrupts();
  std::signal(SIGPIPE, SIG_IGN);
  int code = static_cast<int>(weir::ErrorKind::internal);
  try {
    code = run(argc, argv, rank);
  } catch (const std::exception& error) {  // only this process fails: the others would wait for it
    const weir::Error fault = weir::fault_of(error);
    MPI_Abort(MPI_COMM_WORLD, fail(weir::cat("process ", rank, ": ", fault.what()), fault.exit_code(), true));
  }
  try {
    weir::finish_stdout();
  } catch (const weir::Error& error) {
    if (code == 0) code = fail(error.what(), error.exit_code(), true);  // otherwise its own error was printed already
  }
  MPI_Finalize();
  return code;
}
