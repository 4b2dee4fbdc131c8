#include "tools/options/trace_option.h"

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// The first bytes of each file that Trace writes. A trace is empty if weir was killed before its first write.
constexpr std::string_view kTraceStart = "[\n{\"name\":\"thread_name\",\"ph\":\"M\"";

// Returns whether `path` is missing, empty, a trace of weir, or a device or pipe, which loses nothing.
bool may_be_replaced(const std::string& path) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return true;
  if (std::filesystem::file_size(path, failure) == 0) return true;
  std::ifstream file(path, std::ios::binary);  // an unreadable file is not known to be a trace
  std::string start(kTraceStart.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start == kTraceStart;
}

}  // namespace

void add_trace_option(CLI::App& command, std::string& path) {
  command
      .add_option("--trace", path,
                  "write what each thread did when, as Chrome trace events, for chrome://tracing or ui.perfetto.dev; a "
                  "trace that is there is replaced, another file is not")
      ->type_name("FILE")
      ->group("Run");
}

std::unique_ptr<Trace> open_trace(const std::string& path, std::span<const std::string> others) {
  if (path.empty()) return nullptr;
  for (const std::string& other : others) {
    std::error_code ignored;
    if (path == other || std::filesystem::equivalent(path, other, ignored)) {
      throw Error(ErrorKind::usage, cat("--trace ", path, ": is an input or an output; choose another"));
    }
  }
  std::error_code failure;
  const std::filesystem::path directory = std::filesystem::path(path).parent_path();
  if (!directory.empty() &&
      std::filesystem::status(directory, failure).type() == std::filesystem::file_type::not_found &&
      failure != std::errc::not_a_directory) {
    throw Error(ErrorKind::io, cat("--trace ", path, ": the directory ", directory.string(),
                                   " does not exist; make it or choose another"));
  }
  if (!may_be_replaced(path)) throw usage_error(cat("--trace ", path, ": exists and is no trace; choose another"));
  return std::make_unique<Trace>(path);
}

}  // namespace weir
