#include "tests/tools/project/document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::document_test {
namespace {

using test::CommandBlock;
using test::Document;
using test::parse_document;

TEST(ParseDocument, BlocksWithTheirMarks) {
  const Document document =
      parse_document(R"(Text with [a link](docs/a.md#part), [another](b.md) and [one more](https://x.y).

<!-- before: touch x
touch y -->
```sh
cat x
cat y
```

<!-- fails: 3 -->
```sh
weir convert x
```
```text
weir: no
```

<!-- not run: it takes all night -->
```sh
weir watch
```

```toml
a = 1
```
)");
  ASSERT_EQ(document.blocks.size(), 3U);
  const CommandBlock& first = document.blocks[0];
  EXPECT_EQ(first.line, 6);
  EXPECT_EQ(first.before, "touch x\ntouch y");
  EXPECT_EQ(first.commands, "cat x\ncat y\n");
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_EQ(document.blocks[1].exit_code, 3);
  EXPECT_EQ(document.blocks[1].message, "weir: no\n");
  EXPECT_EQ(document.blocks[2].not_run, "it takes all night");
  EXPECT_EQ(document.links, (std::vector<std::string>{"docs/a.md", "b.md"}));
}

TEST(ParseDocument, UnknownOrMisplacedMarksAreErrors) {
  const auto refusal = [](const char* text) {
    try {
      parse_document(text);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(refusal("\n<!-- befor: x -->\n```sh\n```\n"), "line 2: no mark is called \"befor\"");
  EXPECT_EQ(refusal("<!-- fails: 3 -->\ntext\n"), "line 2: a mark stands before no block of commands");
  EXPECT_EQ(refusal("<!-- not run: -->\n```sh\n```\n"), "line 1: \"not run:\" is no mark: NAME: TEXT");
}

/// Returns the paths of the documents for users, relative to the source tree.
std::vector<std::filesystem::path> documents() {
  std::vector<std::filesystem::path> result{"README.md"};
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(WEIR_SOURCE_DIR) / "docs")) {
    if (entry.path().extension() == ".md") result.push_back("docs" / entry.path().filename());
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::string name_of(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = info.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class Documentation : public testing::TestWithParam<std::filesystem::path> {
 protected:
  std::filesystem::path path() const { return std::filesystem::path(WEIR_SOURCE_DIR) / GetParam(); }
};

TEST_P(Documentation, LinksPointToExistingFiles) {
  for (const std::string& link : parse_document(read_file(path())).links) {
    EXPECT_TRUE(std::filesystem::exists(path().parent_path() / link)) << link;
  }
}

/// Returns the number of cells in a row of a table. Escaped bars do not separate cells.
std::size_t cells(const std::string& row) {
  std::size_t bars = 0;
  for (std::size_t i = 0; i < row.size(); ++i) bars += row[i] == '|' && (i == 0 || row[i - 1] != '\\') ? 1 : 0;
  return bars - 1;
}

TEST_P(Documentation, TablesHaveOneRowALine) {
  const std::vector<std::string> lines = split(read_file(path()), '\n');
  const auto is_row = [&](std::size_t at) { return at < lines.size() && lines[at].starts_with('|'); };
  for (std::size_t at = 0; at < lines.size(); ++at) {
    if (!is_row(at) || (at > 0 && is_row(at - 1))) continue;
    ASSERT_TRUE(is_row(at + 1)) << "line " << at + 1;
    EXPECT_EQ(lines[at + 1].find_first_not_of("|-: "), std::string::npos) << "line " << at + 2 << ": " << lines[at + 1];
    for (std::size_t row = at; is_row(row); ++row) {
      EXPECT_TRUE(lines[row].ends_with('|')) << "line " << row + 1 << ": " << lines[row];
      EXPECT_EQ(cells(lines[row]), cells(lines[at])) << "line " << row + 1 << ": " << lines[row];
    }
  }
}

TEST_P(Documentation, CommandsGiveTheDocumentedResults) {
  const TemporaryDirectory directory;
  CommandOptions options;
  options.directory = directory.path();
  options.environment = {
      cat("PATH=", std::filesystem::path(WEIR_COMMAND).parent_path().string(), ":", std::getenv("PATH")),
      cat("WEIR_SOURCE=", WEIR_SOURCE_DIR)};
  for (const CommandBlock& block : parse_document(read_file(path())).blocks) {
    if (!block.not_run.empty()) continue;
    const auto run = [&](const std::string& script) {
      return run_command({"bash", "-euo", "pipefail", "-c", script}, options);
    };
    const std::string place = cat(GetParam().string(), ", line ", block.line);
    if (!block.before.empty()) {
      const CommandResult made = run(block.before);
      ASSERT_EQ(made.exit_code, 0) << place << ", before it: " << made.err;
    }
    const CommandResult result = run(block.commands);
    ASSERT_EQ(result.exit_code, block.exit_code) << place << ":\n" << result.err;
    if (!block.message.empty()) {
      EXPECT_EQ(result.err, block.message) << place;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Documentation, testing::ValuesIn(documents()), name_of);

TEST(FormatDocument, LinksPointToExistingFiles) {
  const std::filesystem::path format = std::filesystem::path(WEIR_SOURCE_DIR) / "format";
  const auto links = parse_document(read_file(format / "FORMAT.md")).links;
  EXPECT_GT(links.size(), 5U);
  for (const std::string& link : links) EXPECT_TRUE(std::filesystem::exists(format / link)) << link;
}

// Nobody would read a page without a link to it.
TEST(DocumentationIndex, ReadmeLinksToEveryPage) {
  const auto links = parse_document(read_file(std::filesystem::path(WEIR_SOURCE_DIR) / "README.md")).links;
  for (const std::filesystem::path& page : documents()) {
    if (page == "README.md") continue;
    EXPECT_NE(std::find(links.begin(), links.end(), page.string()), links.end()) << page;
  }
}

}  // namespace
}  // namespace weir::document_test
