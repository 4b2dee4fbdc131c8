// Tests the patterns in CMakePresets.json and tests/left_out/, which select the tests that a build runs or leaves out.
// Each pattern must match a test, because otherwise it has no effect.
#include <fnmatch.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::test_patterns_test {
namespace {

/// Returns the first two arguments of each call of the macro `name` at the beginning of a line.
std::vector<std::pair<std::string, std::string>> calls(const std::string& source, const std::string& name) {
  std::vector<std::pair<std::string, std::string>> found;
  const std::string begin = "\n" + name + "(";
  for (std::size_t at = source.find(begin); at != std::string::npos; at = source.find(begin, at + 1)) {
    const std::size_t first = at + begin.size();
    const std::vector<std::string> words = split(source.substr(first, source.find_first_of(");", first) - first), ',');
    if (words.size() < 2) continue;
    found.emplace_back(words[0], words[1].substr(std::min(words[1].size(), words[1].find_first_not_of(" \n"))));
  }
  return found;
}

/// Returns the tests as "Suite.Name", or as "Prefix/Suite.Name" for each set of parameters, without the parameters'
/// names.
std::vector<std::string> test_names() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::recursive_directory_iterator(WEIR_SOURCE_DIR "/tests")) {
    if (file.path().extension() != ".cpp" && file.path().extension() != ".cu") continue;
    const std::string source = read_file(file.path());
    for (const char* const macro : {"TEST", "TEST_F"}) {
      for (const auto& [suite, name] : calls(source, macro)) names.push_back(cat(suite, '.', name));
    }
    const auto sets = calls(source, "INSTANTIATE_TEST_SUITE_P");
    for (const auto& [suite, name] : calls(source, "TEST_P")) {
      for (const auto& [prefix, of_suite] : sets) {
        if (of_suite == suite) names.push_back(cat(prefix, prefix.empty() ? "" : "/", suite, '.', name));
      }
    }
  }
  return names;
}

/// Returns the patterns of a preset's variable. It lists them, separated by colons, or names a file with a pattern per
/// line as @FILE.
std::vector<std::string> patterns_of(const std::string& variable) {
  const std::string file = "@${sourceDir}";
  if (!variable.starts_with(file)) return split(variable, ':');
  std::vector<std::string> lines = split(read_file(WEIR_SOURCE_DIR + variable.substr(file.size())), '\n');
  std::erase_if(lines, [](const std::string& line) { return line.empty() || line[0] == '#'; });
  return lines;
}

TEST(TestPatterns, EachOfThePresets_FitsATest) {
  const std::vector<std::string> names = test_names();
  ASSERT_GE(names.size(), 2000U);
  std::size_t looked_at = 0;
  const auto presets = nlohmann::json::parse(read_file(WEIR_SOURCE_DIR "/CMakePresets.json"));
  for (const auto& preset : presets.at("configurePresets")) {
    for (const char* const variable : {"WEIR_TESTS", "WEIR_TESTS_LEFT_OUT"}) {
      const auto variables = preset.value("cacheVariables", nlohmann::json::object());
      if (!variables.contains(variable)) continue;
      for (const std::string& pattern : patterns_of(variables.at(variable).get<std::string>())) {
        ++looked_at;
        const std::size_t parameter = pattern.find('/', pattern.find('.'));
        const std::string without_parameter = pattern.substr(0, parameter);
        EXPECT_TRUE(std::any_of(
            names.begin(), names.end(),
            [&](const std::string& name) { return ::fnmatch(without_parameter.c_str(), name.c_str(), 0) == 0; }))
            << preset.at("name") << ", " << variable << ": " << pattern;
      }
    }
  }
  EXPECT_GE(looked_at, 100U);
}

}  // namespace
}  // namespace weir::test_patterns_test
