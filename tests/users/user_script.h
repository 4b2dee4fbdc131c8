// Test fixture: a user's directory with inputs as other programs write them, and functions that run commands in it.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/python.h"
#include "tests/support/run_command.h"

namespace weir {

class UserScript : public testing::Test {
 protected:
  /// Runs a Python script in the directory. `script` must hold no single quote.
  void write_inputs(const std::string& script) const {
    ASSERT_TRUE(run_python("import sys, os, numpy as np, h5py, netCDF4\nos.chdir(sys.argv[1])\n" + script,
                           directory_.path().string()));
  }
  /// Runs `weir ARGUMENTS` in the directory.
  CommandResult weir(const std::vector<std::string>& arguments) const {
    CommandOptions options;
    options.directory = directory_.path();
    return run_weir(arguments, options);
  }
  /// Runs a line in a shell, as a message shows it ("weir convert a.nc --dataset /qc").
  CommandResult type(const std::string& line) const {
    CommandOptions options;
    options.directory = directory_.path();
    return run_command({"bash", "-c", "weir() { " WEIR_COMMAND " \"$@\"; }\n" + line}, options);
  }
  /// Runs the convert commands that inspect prints for `input`. Returns how many succeeded.
  int run_printed_commands(const std::string& input) const {
    std::istringstream lines(weir({"inspect", input}).out);
    int done = 0;
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("  weir convert ")) continue;
      const CommandResult made = type(line);
      EXPECT_EQ(made.exit_code, 0) << line << ": " << made.err;
      done += made.exit_code == 0 ? 1 : 0;
    }
    return done;
  }
  nlohmann::json sidecar(const std::string& volume) const {
    return nlohmann::json::parse(read_file(directory_ / (volume + ".json")));
  }
  static bool can_write() { return python_has("h5py, numpy, netCDF4"); }

  TemporaryDirectory directory_;
};

}  // namespace weir
