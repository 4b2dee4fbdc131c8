// weir view: serves a page that shows a NanoVDB file or a series.
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "compressor/options/conversion_request.h"
#include "compressor/resume/work_directory.h"
#include "daemon/config/token_file.h"
#include "daemon/jobs/worker_process.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "tools/command.h"
#include "tools/options/backend_choice.h"
#include "tools/options/picture_options.h"
#include "tools/options/table_options.h"
#include "tools/report/progress.h"
#include "tools/report/standard_output.h"
#include "tools/view/base/stop_signals.h"
#include "tools/view/memory_check.h"
#include "tools/view/source_preview.h"
#include "tools/view/view_server.h"

namespace weir {
namespace {

struct ViewArguments {
  std::string input;
  std::string against;
  std::string listen = "127.0.0.1:0";
  std::string token_file;
  std::uint64_t viewers = 8;
  std::int64_t pixels = kMostViewPixels;
  bool open = false;
  bool allow_convert = false;
  bool series = false;
  bool for_program = false;
  std::string forecast_memory;
  std::string forecast_bandwidth;
  std::string work_dir;
  GivenOptions backend;
  GivenOptions source;
  ProgressOptions progress;
};

constexpr std::uint64_t kMostViewers = 256;
constexpr std::int64_t kLeastViewPixels = 10'000;

// Sets the resources of a forecast: the memory that was asked for, otherwise as much as pictures may use. A program
// that starts weir view (`for_program`) plans its memory, so it gets no forecasts unless it names a size.
void set_forecasts(const ViewArguments& arguments, ViewSettings& settings) {
  const auto given = [&](const char* key) {
    const auto found = arguments.backend.find(key);
    return found == arguments.backend.end() ? std::string() : found->second;
  };
  std::optional<std::uint64_t> memory;
  if (!arguments.forecast_memory.empty()) {
    memory = parse_bytes(arguments.forecast_memory);
    if (!memory || (*memory != 0 && *memory < kLeastMemory)) {
      throw Error(ErrorKind::usage, compose(option("forecast-memory", arguments.forecast_memory),
                                            " must be a size of at "
                                            "least ",
                                            format_bytes(kLeastMemory), ", like 512MiB, or 0 for no forecast"));
    }
  } else if (arguments.for_program) {
    memory = 0;
  } else if (const auto pictures = parse_bytes(given("memory"))) {
    memory = std::max(*pictures, kLeastMemory);
  }
  settings.forecast = memory != std::uint64_t{0};
  if (memory) settings.forecast_options.push_back(cat("--memory=", *memory));
  if (given("backend") == "cpu") settings.forecast_options.emplace_back("--backend=cpu");
  // No --threads: a forecast takes as many threads as its memory allows; a fixed number might not fit.
  if (!arguments.work_dir.empty()) settings.forecast_options.push_back(cat("--work-dir=", arguments.work_dir));
  if (!arguments.forecast_bandwidth.empty()) {
    if (parse_bytes(arguments.forecast_bandwidth).value_or(0) == 0) {
      throw Error(ErrorKind::usage, compose(option("forecast-bandwidth", arguments.forecast_bandwidth),
                                            " must be a size above 0, like 200MB (a second)"));
    }
    settings.forecast_options.push_back(cat("--bandwidth=", arguments.forecast_bandwidth));
  }
}

ViewSettings settings_of(const ViewArguments& arguments) {
  ViewSettings settings;
  settings.address = parse_listen_address(arguments.listen, "--listen");
  if (settings.address.is_unix()) {
    throw Error(ErrorKind::usage, compose(option("listen", arguments.listen), " must be HOST:PORT, for a browser"));
  }
  if (!arguments.token_file.empty()) {
    settings.token = read_token_file(arguments.token_file);
    if (const std::string fault = token_fault(settings.token); !fault.empty()) {
      throw input_error(arguments.token_file, fault);
    }
  }
  if (arguments.for_program) {
    if (arguments.progress.descriptor < 0) {
      throw Error(ErrorKind::usage, compose(option("private"), " tells its token to ", option("progress-fd", "N"),
                                            " alone; give that, too"));
    }
    if (!settings.token.empty()) {
      throw Error(ErrorKind::usage,
                  compose(option("private"), " makes a token of its own; leave ", option("token-file"), " out"));
    }
    settings.token = make_token();
    settings.any_host = true;
  }
  settings.viewers = arguments.viewers;
  settings.pixels = arguments.pixels;
  settings.allow_convert = arguments.allow_convert;
  set_forecasts(arguments, settings);
  settings.program = "/proc/self/exe";
  settings.version = WEIR_VERSION;
  return settings;
}

// Opens the desktop's browser. Without a browser, the address is still on stdout.
std::unique_ptr<WorkerProcess> open_browser(boost::asio::io_context& io, const std::string& address) {
  return std::make_unique<WorkerProcess>(
      io, WorkerCommand{"/usr/bin/xdg-open", {"xdg-open", address}, 0, IoClass::none}, [](std::string_view) {},
      [address](const WorkerEnd& end) {
        if (end.exit_code != 0) spdlog::warn("xdg-open found no browser; open {} yourself", address);
      });
}

// Temporary conversions of inputs that are no NanoVDB files; removed with the object.
struct OpenedSources {
  std::optional<SourcePreview> shown;
  std::optional<SourcePreview> compared;
};

// Converts INPUT and --against if they are sources, and refuses options that go with other inputs.
void open_sources(const ViewArguments& arguments, const BackendChoice& choice, ViewSettings& settings,
                  OpenedSources& sources) {
  if (is_source(arguments.input)) {
    sources.shown.emplace(arguments.input, arguments.source, arguments.work_dir, choice.memory.ceiling,
                          arguments.progress);
    settings.preview_of = arguments.input;
    settings.render_input = dense_words(arguments.input, arguments.source);
  }
  if (!arguments.against.empty() && is_source(arguments.against)) {
    sources.compared.emplace(arguments.against, arguments.source, arguments.work_dir, choice.memory.ceiling,
                             arguments.progress, SourcePreview::Kept::all);
  }
  const bool converts = sources.shown || sources.compared;
  if (const std::string key = given_input_option(arguments.source); !converts && !key.empty()) {
    throw Error(ErrorKind::usage, compose(option(key), cat(" says how to read a source, and ", arguments.input,
                                                           " is shown as it is; leave it out")));
  }
  if (sources.shown && arguments.series) {
    throw Error(ErrorKind::usage, compose(option("series"), cat(" is of a NanoVDB file, and ", arguments.input,
                                                                " is converted to be seen; leave it out")));
  }
}

// Prints the page's URL, and writes its address, with the token where there is one, to --progress-fd.
void tell_address(const ProgressOptions& progress, const ListenAddress& address, const std::string& url,
                  const std::string& token) {
  std::printf("%s\n", url.c_str());
  finish_stdout();  // a page is useless if its address was not printed
  nlohmann::ordered_json told{{"address", address.text()}};
  if (!token.empty()) told["token"] = token;
  announce(progress, told.dump());
}

void view(const ViewArguments& arguments) {
  // Checked now, because the conversions for previews and forecasts may come much later.
  if (!arguments.work_dir.empty()) check_work_directory(*make_posix_file_system(), arguments.work_dir);
  ViewSettings settings = settings_of(arguments);
  BackendChoice choice = read_backend_choice(arguments.backend);
  OpenedSources sources;
  open_sources(arguments, choice, settings, sources);
  ViewedFiles files = find_viewed_files({sources.shown ? sources.shown->file() : arguments.input, arguments.series},
                                        sources.compared ? sources.compared->file() : arguments.against);
  if (sources.shown || sources.compared) {  // the preview's file has a new name each time
    files.key = viewed_key({arguments.input, arguments.series}, arguments.against);
  }
  choice.memory.volumes = volumes_held(files);
  const std::unique_ptr<Backend> backend = make_backend(choice, warn);
  if (const SeriesSummary& seen = files.heads.summary(); !seen.turned.empty()) spdlog::warn("{}", seen.turned);
  if (const std::string& difference = files.heads.summary().difference; !difference.empty()) {
    spdlog::warn("{}", difference);
  }

  boost::asio::io_context io;
  const StopSignals signals(io, [&] { io.stop(); });
  // Unreadable files end the command here, before the page is served.
  for (const std::string& fault : begin_with_readable(files)) {
    spdlog::warn("{}; the page begins with {}", fault, files.steps.front());
  }
  const auto named = [&](const std::string& path) {
    if (sources.shown && path == sources.shown->file()) return arguments.input;
    return sources.compared && path == sources.compared->file() ? arguments.against : path;
  };
  if (lies_elsewhere(files)) {
    spdlog::warn("{} and {} have other index boxes, voxel sizes or origins; each is shown where it lies in the world",
                 named(files.steps.front()), named(files.against.front()));
  }
  if (backend->name() == "cpu") require_memory(files, choice.memory, named);
  ListenAddress address = settings.address;
  const std::string token = arguments.for_program ? settings.token : "";
  ViewServer server(io, std::move(settings), std::move(files), *backend);
  if (interrupt_flag()) throw Error(ErrorKind::interrupted, "interrupted before it was ready");
  address.port = server.port();
  const std::string url = "http://" + address.text() + "/";
  tell_address(arguments.progress, address, url, token);
  std::unique_ptr<WorkerProcess> browser;
  if (arguments.open) browser = open_browser(io, url);
  io.run();
}

}  // namespace

void add_view(CLI::App& app) {
  auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command =
      app.add_subcommand("view", "Serves a page that shows NanoVDB files, turned and coloured in a browser");
  command
      ->add_option(
          "input", arguments->input,
          "a NanoVDB file, a pattern in quotes, 'steps_*.nvdb', or a directory of them; an input of convert is "
          "shown through a quick packed conversion")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--against", arguments->against,
                   "another file, or a pattern or directory of as many, to compare with; an input of convert is "
                   "compared with as it is, converted without loss")
      ->type_name("FILE");
  command->add_option("--listen", arguments->listen, "address of the page; port 0 takes a free one")
      ->type_name("HOST:PORT")
      ->capture_default_str();
  command
      ->add_option("--token-file", arguments->token_file,
                   "file of a token that pages ask for; needed where other machines can reach the address")
      ->type_name("FILE");
  command->add_option("--viewers", arguments->viewers, "pages that may be open at a time")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, kMostViewers))
      ->capture_default_str();
  command
      ->add_option("--pixels", arguments->pixels,
                   "largest picture, in pixels; each page needs about 30 bytes per pixel")
      ->type_name("N")
      ->check(CLI::Range(kLeastViewPixels, kMostViewPixels))
      ->capture_default_str();
  command->add_flag("--series", arguments->series,
                    "with the files beside it whose names differ from its own in numbers alone, as steps");
  command->add_flag("--open", arguments->open, "opens the page in a browser");
  command->add_flag("--allow-convert", arguments->allow_convert,
                    "lets pages have the source converted for the scene they show, beside the file");
  command->add_flag("--private", arguments->for_program,
                    "make a token and print it with the address to --progress-fd only, for a proxy");
  command
      ->add_option(
          "--forecast-memory", arguments->forecast_memory,
          "of a forecast for \"Convert for this scene\", a process of its own; 0: none. As --memory, or as weir "
          "convert takes; none with --private")
      ->type_name("BYTES");
  command
      ->add_option("--forecast-bandwidth", arguments->forecast_bandwidth,
                   "most bytes per second that a forecast reads and writes, in the long run; default: no limit")
      ->type_name("SIZE");
  command
      ->add_option("--work-dir", arguments->work_dir,
                   "directory for the preview of an input and for forecasts; default: TMPDIR")
      ->type_name("DIR");
  add_backend_options(*command, arguments->backend);
  add_input_options_of_one(*command, arguments->source);
  add_progress_options(*command, arguments->progress);
  add_log_level(*command);
  command->callback([arguments] { view(*arguments); });
}

}  // namespace weir
