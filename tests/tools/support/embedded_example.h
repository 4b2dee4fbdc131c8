// examples/embed, built as a user would build it, and a file for its programs to sample.
#pragma once

#include <string>
#include <vector>

#include "tests/support/run_command.h"

namespace weir {

class EmbeddedExample {
 public:
  /// Configured with these options, by the tools that weir is built with; what goes wrong fails the test.
  explicit EmbeddedExample(const std::vector<std::string>& options);

  /// A volume of 16^3 voxels, x + 20 y + 400 z: linear, so that every trilinear value is exact.
  std::string file() const { return directory_ / "a.nvdb"; }
  CommandResult run(const std::string& program, std::vector<std::string> arguments) const;
  /// Whether the example's build has this program.
  bool has(const std::string& program) const;
  /// What the configuration printed.
  const std::string& configuration() const { return configuration_; }

 private:
  const TemporaryDirectory directory_;
  std::string configuration_;
};

}  // namespace weir
