#include "tools/options/command_message.h"

#include <CLI/CLI.hpp>

#include <string_view>
#include <vector>

namespace weir {

std::string command_message(const CLI::App& app, const Error& error) {
  std::string text = error.what();
  const Message remedy = disk_full_remedy();
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  if (!text.ends_with(remedy.text()) || parsed.empty()) return text;
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
