// Parses a document: the commands that it shows, in the order in which a reader runs them, and its links.
//
//   ```sh                 a block of commands, run by bash in an empty folder that all blocks of the document share
//   <!-- before: ... -->  before a block: hidden commands that make the block's inputs
//   <!-- fails: N -->     the block ends with exit code N; a ```text block directly after it is its stderr
//   <!-- not run: WHY --> nobody runs the block
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weir::test {

struct CommandBlock {
  int line = 0;  ///< line of the document at which the commands begin
  std::string before;
  std::string commands;
  int exit_code = 0;
  std::string message;  ///< expected stderr; empty: anything
  std::string not_run;  ///< why the block is not run; empty: it is run
};

struct Document {
  std::vector<CommandBlock> blocks;
  std::vector<std::string> links;  ///< links to other files of the project, without anchors, each once
};

/// Parses a document. Throws std::runtime_error with the line of an unknown mark or of a mark that precedes no block.
Document parse_document(std::string_view text);

}  // namespace weir::test
