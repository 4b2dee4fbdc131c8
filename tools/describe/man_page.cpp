#include "tools/describe/man_page.h"

#include <algorithm>

#include "format/base/text.h"
#include "tools/describe/man_examples.h"
#include "tools/describe/man_text.h"

namespace weir {
namespace {

/// Returns the name as it is typed, "weir convert".
std::string typed_name(const CommandDescription& command) {
  return command.name == "weir" ? command.name : "weir " + command.name;
}

std::string argument_of(const OptionDescription& option) {
  if (option.choices.empty()) return man_italic(option.argument);
  std::string result;
  for (const std::string& choice : option.choices) result += cat(result.empty() ? "" : "|", man_bold(choice));
  return result;
}

std::string synopsis(const CommandDescription& command, bool has_commands) {
  std::string line = man_bold(typed_name(command));
  std::string optional;
  for (const OptionDescription& option : command.options) {
    if (option.positional) continue;
    if (option.required) line += cat(' ', man_bold(option.names.front()), ' ', argument_of(option));
    if (!option.required) optional = cat(" [", man_italic("OPTION"), "]...");
  }
  line += optional;
  if (has_commands) line += cat(' ', man_italic("COMMAND"), " [", man_italic("ARGUMENT"), "]...");
  for (const OptionDescription& option : command.options) {
    if (!option.positional) continue;
    const std::string name = man_italic(option.names.front()) + (option.repeated ? "..." : "");
    line += option.required ? cat(' ', name) : cat(" [", name, "]");
  }
  return line;
}

std::string entry(const OptionDescription& option) {
  std::string tag;
  for (const std::string& name : option.names) {
    tag += cat(tag.empty() ? "" : ", ", option.positional ? man_italic(name) : man_bold(name));
  }
  if (!option.positional && !option.argument.empty()) tag += ' ' + argument_of(option);
  std::string text = man_escaped(option.text);
  if (!option.default_value.empty()) text += cat("; default: ", man_escaped(option.default_value));
  return cat(".TP\n", tag, '\n', text.empty() ? "\\&" : text, '\n');
}

// Returns positionals, options and the named groups of options, each under its own heading.
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

std::string examples_of(const CommandDescription& command) {
  std::string page;
  for (const ManExample& example : man_examples()) {
    if (example.command != command.name) continue;
    page += cat(page.empty() ? ".SH EXAMPLES\n" : ".PP\n", man_escaped(std::string(example.text)), "\n.PP\n.nf\n.RS\n",
                man_escaped(std::string(example.line)), "\n.RE\n.fi\n");
  }
  return page;
}

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\ninternal fault\n.TP\n2\nusage: a wrong option or argument\n.TP\n3\n"
    "bad input, or none\n.TP\n4\nthe budget cannot be met\n.TP\n5\n"
    "cannot read, write or connect: disk full, permission, no such directory, no service at the address, a plug\\-in "
    "of another build\n.TP\n129\ninterrupted: the terminal was closed (SIGHUP)\n"
    ".TP\n130\ninterrupted: SIGINT or SIGTERM (weir watch and weir view end with 0)\n";

constexpr const char* kEnvironment =
    ".SH ENVIRONMENT\n.TP\nWEIR_TOKEN\ntoken of the service, for weir status, jobs, retry, cancel, pause and resume, "
    "where neither \\-\\-token\\-file nor the file of \\-\\-config has one\n"
    ".TP\nWEIR_DRIVERS\nfolder of the plug\\-ins (weir_hdf5.so and others) instead of lib/weir, an absolute path\n"
    ".TP\nTMPDIR\ndirectory for temporary files of weir view and of weir render \\-\\-volume dense; default: /tmp\n"
    ".TP\nHDF5_PLUGIN_PATH\ndirectories with the plug\\-ins of HDF5's filters, which the HDF5 library reads\n"
    ".TP\nHDF5_VDS_PREFIX, HDF5_EXTFILE_PREFIX\ndirectory in which the files of virtual and of external datasets are "
    "looked for first\n"
    ".TP\nSTATE_DIRECTORY\ndirectory of weir watch's state file, where its configuration names none; systemd sets it\n";

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
  std::string page =
      cat(".TH \"", man_escaped(title), "\" 1 \"\" \"weir ", man_escaped(version), "\" \"User Commands\"\n");
  page += cat(".SH NAME\n", man_escaped(man_page_name(command)), " \\- ", man_escaped(command.text), '\n');
  page += cat(".SH SYNOPSIS\n", synopsis(command, is_root && all.size() > 1), '\n');
  if (is_root) {
    page += ".SH COMMANDS\n";
    for (const CommandDescription& c : all) {
      if (c.name != command.name) page += cat(".TP\n", man_bold(c.name), '\n', man_escaped(c.text), '\n');
    }
  }
  page += options_of(command);
  if (!command.footer.empty()) page += cat(".SH NOTES\n.nf\n", man_escaped(command.footer), "\n.fi\n");
  page += examples_of(command);
  page += kExitStatus;
  if (is_root) page += kEnvironment;
  page += ".SH SEE ALSO\n";
  std::string others;
  for (const CommandDescription& c : all) {
    if (c.name != command.name) others += cat(others.empty() ? "" : ",\n", man_bold(man_page_name(c)), "(1)");
  }
  if (command.name == "watch") others += cat(",\n", man_bold("weir.toml"), "(5)");
  return page + others + '\n';
}

}  // namespace weir
