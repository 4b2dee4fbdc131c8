// A small command line with every shape of option, for tests of the texts that are generated from a command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace weir::test {

class DescribedApp {
 public:
  DescribedApp() : app("Lets water through.", "weir") {
    app.set_version_flag("--version", "9.8.7");
    CLI::App* open = app.add_subcommand("open", "Opens a gate: it's quick");
    open->add_option("gate", words_, "which, see below")->required()->type_name("GATE");
    open->add_option("-w,--width", text_, "of the gap \\ in m")->required()->type_name("METRES");
    open->add_option("--pace", text_, "how fast")->check(CLI::IsMember({"slow", "fast"}))->default_str("slow");
    open->add_option("--side", text_)->type_name("left|right")->group("Place");
    open->add_option("--count", number_, ".of [times]")->type_name("N")->check(CLI::Range(0, 9));
    open->add_flag("--quiet", quiet_, "says nothing");
    open->footer([] { return "Gates:\n  .upper  'first'\n"; });
    CLI::App* measure = app.add_subcommand("measure", "Measures the level");
    measure->add_option("unit", text_, "of the level")->check(CLI::IsMember({"m", "ft"}));
    CLI::App* hidden = app.add_subcommand("hidden", "Is not for people");
    hidden->group("");
  }

  CLI::App app;

 private:
  std::string text_;
  int number_ = 0;
  bool quiet_ = false;
  std::vector<std::string> words_;
};

}  // namespace weir::test
