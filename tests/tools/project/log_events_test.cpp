// Tests that docs/operations.md names every event that the service logs.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "tests/support/run_command.h"

namespace weir::log_events_test {
namespace {

std::set<std::string> matches(const std::string& text, const std::regex& form) {
  std::set<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), form), end; match != end; ++match)
    found.insert((*match)[1]);
  return found;
}

TEST(LogEvents, AreAllDocumented) {
  const std::string manual = read_file(WEIR_SOURCE_DIR "/docs/operations.md");
  const std::size_t first = manual.find("\nEvents: ");
  ASSERT_NE(first, std::string::npos);
  std::set<std::string> documented;
  for (const std::string& names :
       matches(manual.substr(first, manual.find("logrotate", first) - first), std::regex("`([^`]*)`"))) {
    documented.merge(matches(names, std::regex("([a-z-]+)")));
  }
  std::set<std::string> logged;
  for (const auto& file : std::filesystem::recursive_directory_iterator(WEIR_SOURCE_DIR "/daemon")) {
    if (file.path().extension() != ".cpp") continue;
    // A condition may choose the event: `log_.info(gone ? "source-gone" : "source-changed", {`.
    for (const std::string& event :
         matches(read_file(file.path()), std::regex("log_\\.(?:debug|info|warn|error)\\(([^{]*)"))) {
      logged.merge(matches(event, std::regex("\"([a-z-]+)\"")));
    }
  }
  EXPECT_GE(logged.size(), 25U);
  for (const std::string& event : logged) EXPECT_TRUE(documented.contains(event)) << event;
}

}  // namespace
}  // namespace weir::log_events_test
