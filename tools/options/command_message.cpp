#include "tools/options/command_message.h"

#include <CLI/CLI.hpp>

#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

namespace weir {
namespace {

// Returns whether `text` says that a file which `command` was given by a relative name does not exist.
bool misses_a_file(const CLI::App& command, std::string_view text) {
  if (!text.ends_with(": " + std::generic_category().message(ENOENT))) return false;
  const auto begins_with_path = [&](const std::string& path) {
    return text.starts_with(path) && (text.substr(path.size()).starts_with(": ") || text[path.size()] == '/');
  };
  std::error_code ignored;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& word : option->results()) {
      if (word.empty() || word.starts_with('/')) continue;
      const std::filesystem::path absolute = std::filesystem::absolute(word, ignored).lexically_normal();
      if (begins_with_path(word) || begins_with_path(absolute.string())) return true;
    }
  }
  return false;
}

}  // namespace

std::string command_message(const CLI::App& app, const Error& error) {
  std::string text = error.what();
  const Message remedy = disk_full_remedy();
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  if (parsed.empty()) return text;
  if (misses_a_file(*parsed.front(), text)) return text + "; check the name and the current directory";
  if (!text.ends_with(remedy.text())) return text;
  text.resize(text.size() - remedy.text().size());
  text += "; free space on that file system";
  std::string_view before = " or choose another with ";
  for (const std::string& key : remedy.option_keys()) {
    if (parsed.front()->get_option_no_throw("--" + key) == nullptr) continue;
    text.append(before).append(command_line_wording(option(key)));
    before = " or ";
  }
  return text;
}

}  // namespace weir
