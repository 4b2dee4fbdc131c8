#include "tools/describe/shell_completion.h"

#include <span>

#include "format/base/text.h"

namespace weir {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : separator) + word;
  return result;
}

/// Returns `text` in single quotes, as all three shells read them.
std::string quoted(const std::string& text, const std::string& quote_inside) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? quote_inside : std::string(1, c);
  return result + "'";
}

/// Returns `text` with a backslash before each character of `special`.
std::string guarded(const std::string& text, const std::string& special) {
  std::string result;
  for (const char c : text) {
    if (special.find(c) != std::string::npos) result += '\\';
    result += c;
  }
  return result;
}

std::span<const CommandDescription> subcommands(const std::vector<CommandDescription>& commands) {
  return std::span(commands).subspan(1);
}

std::string option_names(const CommandDescription& command) {
  std::vector<std::string> names;
  for (const OptionDescription& option : command.options) {
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return joined(names, " ");
}

/// Returns the values of the first positional that has a list.
std::vector<std::string> positional_choices(const CommandDescription& command) {
  for (const OptionDescription& option : command.options) {
    if (option.positional && !option.choices.empty()) return option.choices;
  }
  return {};
}

std::string bash_case(const CommandDescription& command, const std::string& label, const std::string& words) {
  std::string values;
  for (const OptionDescription& option : command.options) {
    if (option.positional || option.argument.empty()) continue;
    values += cat("        ", joined(option.names, "|"), ")");
    // Without a list no words are given, so that the shell completes file names.
    values += option.choices.empty() ? " return ;;\n" : cat(" words='", joined(option.choices, " "), "' ;;\n");
  }
  std::string text =
      cat("    ", label, ")\n      words=", quoted(words, "'\\''"), "\n      options='", option_names(command), "'\n");
  if (!values.empty()) text += cat("      case $previous in\n", values, "      esac\n");
  return text + "      ;;\n";
}

std::string zsh_option(const OptionDescription& option) {
  std::string names;
  if (option.names.size() == 1) {
    names = option.names.front();
  } else {
    names = cat("'(", joined(option.names, " "), ")'{", joined(option.names, ","), "}");
  }
  std::string rest = cat("[", guarded(option.text, "[]\\:"), "]");
  if (!option.argument.empty()) {
    rest += cat(":", guarded(option.argument, "[]\\: "), ":",
                option.choices.empty() ? "_files" : cat("(", joined(option.choices, " "), ")"));
  }
  return names + quoted(rest, "'\\''");
}

std::string fish_option(const std::string& condition, const OptionDescription& option) {
  std::string line = cat("complete -c weir -n ", condition);
  for (const std::string& name : option.names) {
    line += name.starts_with("--") ? cat(" -l ", name.substr(2)) : cat(" -s ", name.substr(1));
  }
  if (!option.choices.empty()) {
    line += cat(" -x -a '", joined(option.choices, " "), "'");
  } else if (!option.argument.empty()) {
    line += " -r";
  }
  return cat(line, " -d ", quoted(guarded(option.text, "\\"), "\\'"), '\n');
}

}  // namespace

std::string bash_completion(const std::vector<CommandDescription>& commands) {
  std::vector<std::string> names;
  for (const CommandDescription& command : subcommands(commands)) names.push_back(command.name);
  std::string cases = bash_case(commands.front(), "''", joined(names, " "));
  for (const CommandDescription& command : subcommands(commands)) {
    cases += bash_case(command, command.name, joined(positional_choices(command), " "));
  }
  return cat(R"(# bash completion for weir, written by `weir completion bash`.
_weir() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} command='' words='' options='' word
  COMPREPLY=()
  # bash takes --option=value for three words.
  if [[ $current == '=' ]]; then
    current=''
  elif [[ $previous == '=' ]]; then
    previous=${COMP_WORDS[COMP_CWORD-2]}
  fi
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word != -* ]]; then
      command=$word
      break
    fi
  done
  case $command in
)",
             cases, R"(  esac
  if [[ $current == -* ]]; then
    words=$options
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
complete -o bashdefault -o default -F _weir weir
)");
}

std::string zsh_completion(const std::vector<CommandDescription>& commands) {
  std::string list;
  std::string cases;
  for (const CommandDescription& command : subcommands(commands)) {
    list += cat("    ", quoted(cat(command.name, ":", guarded(command.text, "\\:")), "'\\''"), '\n');
    cases += cat("    ", command.name, ")\n      _arguments -s -S");
    for (const OptionDescription& option : command.options) {
      if (!option.positional) cases += cat(" \\\n        ", zsh_option(option));
    }
    const std::vector<std::string> values = positional_choices(command);
    cases += cat(" \\\n        '*:", values.empty() ? "file:_files" : cat("value:(", joined(values, " "), ")"),
                 "'\n      ;;\n");
  }
  return cat(R"(#compdef weir
# zsh completion for weir, written by `weir completion zsh`.
_weir() {
  local -a commands
  commands=(
)",
             list, R"(  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
)",
             cases, R"(  esac
}
_weir "$@"
)");
}

std::string fish_completion(const std::vector<CommandDescription>& commands) {
  std::string script = "# fish completion for weir, written by `weir completion fish`.\n";
  for (const OptionDescription& option : commands.front().options) {
    if (!option.positional) script += fish_option("__fish_use_subcommand", option);
  }
  for (const CommandDescription& command : subcommands(commands)) {
    script += cat("complete -c weir -n __fish_use_subcommand -f -a ", command.name, " -d ",
                  quoted(guarded(command.text, "\\"), "\\'"), '\n');
  }
  for (const CommandDescription& command : subcommands(commands)) {
    const std::string condition = cat("'__fish_seen_subcommand_from ", command.name, "'");
    for (const OptionDescription& option : command.options) {
      if (!option.positional) script += fish_option(condition, option);
    }
    const std::vector<std::string> values = positional_choices(command);
    if (!values.empty()) script += cat("complete -c weir -n ", condition, " -f -a '", joined(values, " "), "'\n");
  }
  return script;
}

}  // namespace weir
