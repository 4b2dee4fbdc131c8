// A source and its conversion, for tests of weir compare.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_command.h"

namespace weir {

/// A directory with a source and its conversion.
struct ConvertedPair {
  TemporaryDirectory directory;
  std::string raw;
  std::string nvdb = directory / "a.nvdb";

  ConvertedPair(const std::string& kind, const std::string& dims_and_type, const std::vector<std::string>& options)
      : raw(directory / ("a_" + dims_and_type + ".raw")) {
    EXPECT_EQ(run_weir({"sample", kind, "-o", raw}).exit_code, 0);
    std::vector<std::string> convert{"convert", raw, "-o", nvdb};
    convert.insert(convert.end(), options.begin(), options.end());
    const CommandResult result = run_weir(convert);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }

  nlohmann::json compare(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"compare", raw, nvdb, "--json", "--progress", "never"});
    const CommandResult result = run_weir(options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
};

}  // namespace weir
