#include "tools/describe/man_page.h"

#include <algorithm>

#include "format/base/text.h"

namespace weir {
namespace {

/// Text as man(7) takes it: no character of it is a request, dashes can be searched for and copied.
std::string escaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool starts_line = i == 0 || text[i - 1] == '\n';
    if (starts_line && (text[i] == '.' || text[i] == '\'')) result += "\\&";
    if (text[i] == '\\') {
      result += "\\e";
    } else if (text[i] == '-') {
      result += "\\-";
    } else {
      result += text[i];
    }
  }
  return result;
}

std::string bold(const std::string& text) { return cat("\\fB", escaped(text), "\\fR"); }
std::string italic(const std::string& text) { return cat("\\fI", escaped(text), "\\fR"); }

/// "weir convert", as it is typed.
std::string typed_name(const CommandDescription& command) {
  return command.name == "weir" ? command.name : "weir " + command.name;
}

std::string argument_of(const OptionDescription& option) {
  if (option.choices.empty()) return italic(option.argument);
  std::string result;
  for (const std::string& choice : option.choices) result += cat(result.empty() ? "" : "|", bold(choice));
  return result;
}

std::string synopsis(const CommandDescription& command, bool has_commands) {
  std::string line = bold(typed_name(command));
  std::string optional;
  for (const OptionDescription& option : command.options) {
    if (option.positional) continue;
    if (option.required) line += cat(' ', bold(option.names.front()), ' ', argument_of(option));
    if (!option.required) optional = cat(" [", italic("OPTION"), "]...");
  }
  line += optional;
  if (has_commands) line += cat(' ', italic("COMMAND"), " [", italic("ARGUMENT"), "]...");
  for (const OptionDescription& option : command.options) {
    if (!option.positional) continue;
    const std::string name = italic(option.names.front()) + (option.repeated ? "..." : "");
    line += option.required ? cat(' ', name) : cat(" [", name, "]");
  }
  return line;
}

std::string entry(const OptionDescription& option) {
  std::string tag;
  for (const std::string& name : option.names) {
    tag += cat(tag.empty() ? "" : ", ", option.positional ? italic(name) : bold(name));
  }
  if (!option.positional && !option.argument.empty()) tag += ' ' + argument_of(option);
  std::string text = escaped(option.text);
  if (!option.default_value.empty()) text += cat("; default: ", escaped(option.default_value));
  return cat(".TP\n", tag, '\n', text.empty() ? "\\&" : text, '\n');
}

// Positionals, options, and the groups options were put in, each under a heading of its own.
std::string options_of(const CommandDescription& command) {
  std::vector<std::string> groups;
  const auto heading = [](const OptionDescription& option) { return option.positional ? "Arguments" : option.group; };
  for (const OptionDescription& option : command.options) {
    if (option.positional) groups.emplace_back("Arguments");
  }
  for (const OptionDescription& option : command.options) groups.push_back(heading(option));
  std::string page;
  for (auto group = groups.begin(); group != groups.end(); ++group) {
    if (std::find(groups.begin(), group, *group) != group) continue;
    const bool own_section = *group == "Arguments" || *group == "Options";
    std::string title = *group;
    if (own_section) {
      std::transform(title.begin(), title.end(), title.begin(),
                     [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    }
    page += cat(own_section ? ".SH " : ".SS ", title, '\n');
    for (const OptionDescription& option : command.options) {
      if (heading(option) == *group) page += entry(option);
    }
  }
  return page;
}

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\ninternal fault\n.TP\n2\nusage: a wrong option or argument\n.TP\n3\n"
    "bad or unreadable input\n.TP\n4\nthe budget cannot be met\n.TP\n5\ninput or output failed: disk full, permission\n"
    ".TP\n129\ninterrupted: the terminal was closed (SIGHUP)\n.TP\n130\ninterrupted\n";

}  // namespace

std::string man_page_name(const CommandDescription& command) {
  return command.name == "weir" ? command.name : "weir-" + command.name;
}

std::string man_page(const CommandDescription& command, const std::vector<CommandDescription>& all,
                     const std::string& version) {
  const bool is_root = command.name == all.front().name;
  std::string title = man_page_name(command);
  std::transform(title.begin(), title.end(), title.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  std::string page = cat(".TH \"", escaped(title), "\" 1 \"\" \"weir ", escaped(version), "\" \"User Commands\"\n");
  page += cat(".SH NAME\n", escaped(man_page_name(command)), " \\- ", escaped(command.text), '\n');
  page += cat(".SH SYNOPSIS\n", synopsis(command, is_root && all.size() > 1), '\n');
  if (is_root) {
    page += ".SH COMMANDS\n";
    for (const CommandDescription& c : all) {
      if (c.name != command.name) page += cat(".TP\n", bold(c.name), '\n', escaped(c.text), '\n');
    }
  }
  page += options_of(command);
  if (!command.footer.empty()) page += cat(".SH NOTES\n.nf\n", escaped(command.footer), "\n.fi\n");
  page += kExitStatus;
  page += ".SH SEE ALSO\n";
  std::string others;
  for (const CommandDescription& c : all) {
    if (c.name != command.name) others += cat(others.empty() ? "" : ",\n", bold(man_page_name(c)), "(1)");
  }
  return page + others + '\n';
}

}  // namespace weir
