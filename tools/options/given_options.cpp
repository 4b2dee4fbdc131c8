#include "tools/options/given_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>

#include "compressor/options/conversion_request.h"

namespace weir {
namespace {

// Options that are not recorded: they say how a command reports, or whether it runs at all.
constexpr std::array<std::string_view, 14> kSilent{"dry-run",   "help",          "json",      "progress", "progress-fd",
                                                   "log-level", "quiet",         "skip-done", "again",    "brief-names",
                                                   "resume",    "save-interval", "trace",     "backend"};

bool silent(std::string_view key) { return std::find(kSilent.begin(), kSilent.end(), key) != kSilent.end(); }

}  // namespace

std::map<std::string, std::string> given_options(const CLI::App& command, const GivenOptions& read) {
  std::map<std::string, std::string> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    if (silent(name) || is_conversion_option(name)) continue;
    given[name] = option->get_expected_max() == 0 ? "true" : option->results().back();
  }
  given.merge(recorded_options(read));
  return given;
}

std::map<std::string, std::string> recorded_options(const GivenOptions& given) {
  std::map<std::string, std::string> record(given.begin(), given.end());
  std::erase_if(record, [](const auto& option) { return silent(option.first); });
  return record;
}

}  // namespace weir
