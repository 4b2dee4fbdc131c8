#include "tools/options/given_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>

namespace weir {
namespace {

// They say how a command reports, or whether it runs at all.
constexpr std::array<std::string_view, 10> kSilent{"help",      "json",  "progress", "progress-fd",   "log-level",
                                                   "skip-done", "again", "resume",   "save-interval", "trace"};

}  // namespace

std::map<std::string, std::string> given_options(const CLI::App& command) {
  std::map<std::string, std::string> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    if (std::find(kSilent.begin(), kSilent.end(), name) != kSilent.end()) continue;
    given[name] = option->get_expected_max() == 0 ? "true" : option->results().back();
  }
  return given;
}

}  // namespace weir
