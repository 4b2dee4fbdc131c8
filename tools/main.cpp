// The `weir` command: dispatches to the subcommands and turns errors into one line and an exit code.
#include <CLI/CLI.hpp>

#include <csignal>
#include <exception>
#include <string>

#include "format/base/error.h"
#include "format/process/fault.h"
#include "ingest/drivers/hdf5_crash.h"
#include "tools/command.h"
#include "tools/interrupt.h"
#include "tools/options/command_message.h"
#include "tools/options/parse_command_line.h"
#include "tools/options/parse_message.h"
#include "tools/report/error_line.h"
#include "tools/report/standard_output.h"

namespace {

int fail(const std::string& message, int code) {
  weir::print_error_line(message);
  return code;
}

int run(int argc, char** argv) {
  weir::log_in_lines("weir");
  weir::catch_interrupts();
  weir::report_hdf5_crashes();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGCHLD, SIG_DFL);  // the parent may ignore SIGCHLD; then no worker's exit status could be read

  CLI::App app("Streams volumes of any size into NanoVDB files of exactly the size you ask for.", "weir");
  app.set_version_flag("--version", WEIR_VERSION);
  try {
    weir::add_verify(app);
    weir::add_inspect(app);
    weir::add_convert(app);
    weir::add_render(app);
    weir::add_play(app);
    weir::add_view(app);
    weir::add_sample(app);
    weir::add_compare(app);
    weir::add_flip(app);
    weir::add_export(app);
    weir::add_sweep(app);
    weir::add_watch(app);
    weir::add_jobs(app);
    weir::add_status(app);
    weir::add_retry(app);
    weir::add_cancel(app);
    weir::add_pause(app);
    weir::add_resume(app);
    weir::add_completion(app);
    weir::add_man(app);
    weir::parse_command_line(app, argc, argv);
    return 0;
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForVersion& version) {
    return app.exit(version);
  } catch (const CLI::ParseError& error) {
    return fail(weir::parse_message(app, error), static_cast<int>(weir::ErrorKind::usage));
  } catch (const weir::ExitStatus& status) {
    return status.code;
  } catch (const weir::Error& error) {
    return fail(weir::command_message(app, error), weir::exit_code_of(error));
  } catch (const std::exception& error) {
    const weir::Error fault = weir::fault_of(error, "--memory, or a smaller --size of a picture");
    return fail(fault.what(), fault.exit_code());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int code = run(argc, argv);
  try {
    weir::finish_stdout();
  } catch (const weir::Error& error) {
    if (code == 0) return fail(error.what(), error.exit_code());  // otherwise an error was already printed
  }
  return code;
}
