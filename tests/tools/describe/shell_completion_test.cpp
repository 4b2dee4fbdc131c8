#include "tools/describe/shell_completion.h"

#include <gtest/gtest.h>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/tools/support/described_app.h"

namespace weir::shell_completion_test {
namespace {

bool is_installed(const std::string& shell) { return run_command({"sh", "-c", "command -v " + shell}).exit_code == 0; }

class ShellCompletion : public ::testing::Test {
 protected:
  std::string write(std::string (*script)(const std::vector<CommandDescription>&)) const {
    test::DescribedApp described;
    write_file(directory_ / "script", script(describe_commands(described.app)));
    return directory_ / "script";
  }
  /// Returns what bash offers for the last of `words`. Bash splits a line at '=', too.
  std::string bash(const std::string& words) const {
    const std::string line = cat("source ", write(bash_completion), "; COMP_WORDS=(", words,
                                 "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _weir; echo \"${COMPREPLY[*]}\"");
    const CommandResult result = run_command({"bash", "-c", line});
    EXPECT_EQ(result.err, "");
    return result.out;
  }

  TemporaryDirectory directory_;
};

TEST_F(ShellCompletion, Bash) {
  EXPECT_EQ(bash("weir ''"), "open measure\n");
  EXPECT_EQ(bash("weir o"), "open\n");
  EXPECT_EQ(bash("weir -"), "-h --help --version\n");
  EXPECT_EQ(bash("weir open --"), "--help --width --pace --side --count --quiet\n");
  EXPECT_EQ(bash("weir open --w"), "--width\n");
  EXPECT_EQ(bash("weir open --pace ''"), "slow fast\n");
  EXPECT_EQ(bash("weir open --pace f"), "fast\n");
  EXPECT_EQ(bash("weir open --pace = s"), "slow\n");
  EXPECT_EQ(bash("weir open --pace ="), "slow fast\n");
  EXPECT_EQ(bash("weir open --side ''"), "left right\n");
  EXPECT_EQ(bash("weir open --width ''"), "\n") << "file names are the shell's to offer";
  EXPECT_EQ(bash("weir open o"), "\n");
  EXPECT_EQ(bash("weir measure ''"), "m ft\n");
  EXPECT_EQ(bash("weir hidden ''"), "\n");
}

TEST_F(ShellCompletion, Zsh) {
  test::DescribedApp described;
  EXPECT_EQ(zsh_completion(describe_commands(described.app)), R"(#compdef weir
# zsh completion for weir, written by `weir completion zsh`.
_weir() {
  local -a commands
  commands=(
    'open:Opens a gate\: it'\''s quick'
    'measure:Measures the level'
  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
    open)
      _arguments -s -S \
        '(-h --help)'{-h,--help}'[Print this help message and exit]' \
        '(-w --width)'{-w,--width}'[of the gap \\ in m]:METRES:_files' \
        --pace'[how fast]:slow|fast:(slow fast)' \
        --side'[]:left|right:(left right)' \
        --count'[.of \[times\]]:N:_files' \
        --quiet'[says nothing]' \
        '*:file:_files'
      ;;
    measure)
      _arguments -s -S \
        '(-h --help)'{-h,--help}'[Print this help message and exit]' \
        '*:value:(m ft)'
      ;;
  esac
}
_weir "$@"
)");
}

TEST_F(ShellCompletion, Fish) {
  test::DescribedApp described;
  EXPECT_EQ(fish_completion(describe_commands(described.app)),
            R"(# fish completion for weir, written by `weir completion fish`.
complete -c weir -n __fish_use_subcommand -s h -l help -d 'Print this help message and exit'
complete -c weir -n __fish_use_subcommand -l version -d 'Display program version information and exit'
complete -c weir -n __fish_use_subcommand -f -a open -d 'Opens a gate: it\'s quick'
complete -c weir -n __fish_use_subcommand -f -a measure -d 'Measures the level'
complete -c weir -n '__fish_seen_subcommand_from open' -s h -l help -d 'Print this help message and exit'
complete -c weir -n '__fish_seen_subcommand_from open' -s w -l width -r -d 'of the gap \\ in m'
complete -c weir -n '__fish_seen_subcommand_from open' -l pace -x -a 'slow fast' -d 'how fast'
complete -c weir -n '__fish_seen_subcommand_from open' -l side -x -a 'left right' -d ''
complete -c weir -n '__fish_seen_subcommand_from open' -l count -r -d '.of [times]'
complete -c weir -n '__fish_seen_subcommand_from open' -l quiet -d 'says nothing'
complete -c weir -n '__fish_seen_subcommand_from measure' -s h -l help -d 'Print this help message and exit'
complete -c weir -n '__fish_seen_subcommand_from measure' -f -a 'm ft'
)");
}

TEST_F(ShellCompletion, EachShellParsesItsScript) {
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const CommandResult script = run_weir({"completion", shell});
    ASSERT_EQ(script.exit_code, 0) << script.err;
    EXPECT_NE(script.out.find("max-error"), std::string::npos);
    if (!is_installed(shell)) continue;
    write_file(directory_ / shell, script.out);
    const CommandResult read = run_command({shell, "-n", directory_ / shell});
    EXPECT_EQ(read.exit_code, 0) << shell << read.err;
    EXPECT_EQ(read.err, "");
  }
  EXPECT_EQ(run_weir({"completion", "tcsh"}).exit_code, 2);
}

}  // namespace
}  // namespace weir::shell_completion_test
