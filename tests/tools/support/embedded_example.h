// Builds examples/embed as a user would, and makes a file for its programs to sample.
#pragma once

#include <string>
#include <vector>

#include "tests/support/run_command.h"

namespace weir {

class EmbeddedExample {
 public:
  /// Configures and builds with `options`, with the tools that weir is built with; any failure fails the test.
  explicit EmbeddedExample(const std::vector<std::string>& options);

  /// Returns the path of a volume of 16^3 voxels, x + 20 y + 400 z: linear, so that every trilinear value is exact.
  std::string file() const { return directory_ / "a.nvdb"; }
  CommandResult run(const std::string& program, std::vector<std::string> arguments) const;
  /// Returns whether the example's build has `program`.
  bool has(const std::string& program) const;
  /// Returns what the configuration printed.
  const std::string& configuration() const { return configuration_; }

 private:
  const TemporaryDirectory directory_;
  std::string configuration_;
};

}  // namespace weir
