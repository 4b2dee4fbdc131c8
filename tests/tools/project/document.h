// The commands that a document shows, as a reader would run them one after the other, and what it links to.
//
//   ```sh                 a block of commands, run by bash in an empty folder that all blocks of the document share
//   <!-- before: ... -->  ahead of a block: commands that make what it needs, out of a reader's sight
//   <!-- fails: N -->     the block ends with exit code N; a block ```text right behind it is its stderr
//   <!-- not run: WHY --> nobody runs the block
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weir::test {

struct CommandBlock {
  int line = 0;  ///< of the document, where the commands begin
  std::string before;
  std::string commands;
  int exit_code = 0;
  std::string message;  ///< that stderr has to be; empty: anything
  std::string not_run;  ///< why
};

struct Document {
  std::vector<CommandBlock> blocks;
  std::vector<std::string> links;  ///< to other files of the project, without anchors, each once
};

/// Throws std::runtime_error with the line of a mark that is not one of the above, or stands before no block.
Document parse_document(std::string_view text);

}  // namespace weir::test
