#include "tools/options/trace_option.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

void add_trace_option(CLI::App& command, std::string& path) {
  command
      .add_option("--trace", path,
                  "write what each thread did when, as Chrome trace events, for chrome://tracing or ui.perfetto.dev")
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
  return std::make_unique<Trace>(path);
}

}  // namespace weir
