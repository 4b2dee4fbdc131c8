// The table of options about how a conversion uses the machine, and which files it keeps and replaces.
#include <array>

#include "compressor/options/conversion_request.h"

namespace weir {
namespace {

using Request = ConversionRequest;

constexpr std::int64_t kMostThreads = 4096;
constexpr double kMostSeconds = 1e6;

void read_memory(const OptionRow& row, const std::string& text, Request& request) {
  const auto bytes = parse_bytes(text);
  if (!bytes || *bytes < kLeastMemory) {
    throw wrong_option(row.key, text, cat("a size of at least ", format_bytes(kLeastMemory), ", like 512MiB"));
  }
  request.conversion.memory = *bytes;
}

void read_threads(const OptionRow& row, const std::string& text, Request& request) {
  const auto threads = parse_int(text);
  if (!threads || *threads < 0 || *threads > kMostThreads) {
    throw wrong_option(row.key, text, cat("a whole number from 0 to ", kMostThreads));
  }
  request.conversion.threads = static_cast<std::size_t>(*threads);
}

void read_save_interval(const OptionRow& row, const std::string& text, Request& request) {
  const auto seconds = parse_double(text);
  if (!seconds || !(*seconds >= 0 && *seconds <= kMostSeconds)) {
    throw wrong_option(row.key, text, cat("a number of seconds from 0 to ", kMostSeconds));
  }
  request.conversion.save_interval_s = *seconds;
}

constexpr ConversionOption kRunOptions[] = {
    {{.key = "memory",
      .argument = "SIZE",
      .unit = "bytes",
      .standard = "512MiB",
      .help = "ceiling of the whole process"},
     read_memory},
    {{.key = "threads",
      .argument = "N",
      .standard = "0",
      .help = "number of threads; 0: one per core (convert: fewer if --memory is small)"},
     read_threads},
    {{.key = "backend",
      .argument = "auto|cpu|cuda",
      .standard = "auto",
      .help = "what surveys and encodes packed blocks; the bytes are the same. auto: cuda where there is a device and "
              "--memory is 1GiB or more"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.backend =
           std::array{CoderChoice::automatic, CoderChoice::cpu, CoderChoice::cuda}.at(read_choice(row, text));
     }},
    {{.key = "work-dir",
      .argument = "DIRECTORY",
      .standard = "a hidden directory beside the output",
      .help = "for spill files, on a disk"},
     [](const OptionRow&, const std::string& text, Request& r) { r.conversion.work_dir = text; }},
    {{.key = "resume",
      .argument = "auto|on|off",
      .standard = "auto",
      .help = "keep the work of an interrupted or failed conversion in a hidden directory beside the output "
              "(.OUT.nvdb.work): the same command continues it, with the same bytes in the end. auto: for volumes of "
              "1 GiB of float32 or more"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.conversion.resume = std::array{Resume::automatic, Resume::on, Resume::off}.at(read_choice(row, text));
     }},
    {{.key = "save-interval",
      .argument = "SECONDS",
      .unit = "s",
      .standard = "5",
      .help = "between two points that an interrupted conversion can be continued from; 0: as many as there are"},
     read_save_interval},
    {{.key = "overwrite", .help = "replace an existing output"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.conversion.overwrite = read_flag(row, text); }},
};

}  // namespace

std::span<const ConversionOption> run_options() { return kRunOptions; }

}  // namespace weir
