// Tests that weir.toml(5) has exactly the keys that docs/operations.md explains, and that load_config() knows each.
#include "tools/describe/config_page.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "daemon/config/load_config.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source_registry.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::config_page_test {
namespace {

// Returns "table.key" for each row of the tables below `### `[service]`` and `### `[[watch]]`` in docs/operations.md.
std::set<std::string> documented_keys() {
  std::set<std::string> keys;
  std::string table;
  for (const std::string& line : split(read_file(WEIR_SOURCE_DIR "/docs/operations.md"), '\n')) {
    if (line.starts_with("#")) table.clear();
    if (line.starts_with("### `[service]`")) table = "service.";
    if (line.starts_with("### `[[watch]]`")) table = "watch.";
    if (table.empty() || !line.starts_with("| `")) continue;
    const std::string names = line.substr(2, line.find(" |", 2) - 2);
    for (const std::string& name : split(names, ',')) {
      const std::size_t begin = name.find('`') + 1;
      keys.insert(table + name.substr(begin, name.find('`', begin) - begin));
    }
  }
  return keys;
}

TEST(ConfigPage, HasTheKeysOfTheDocument) {
  std::set<std::string> keys;
  for (const ConfigKey& key : config_keys()) keys.insert(cat(key.table, '.', key.key));
  EXPECT_EQ(keys, documented_keys());
}

// No key accepts an array of tables. So the message must complain of the value, not of an unknown key.
TEST(ConfigPage, KeysAreKnownToTheReader) {
  const TemporaryDirectory directory;
  const std::string path = directory / "weir.toml";
  for (const ConfigKey& key : config_keys()) {
    const std::string line = cat(key.key, " = [{}]\n");
    const std::string watch = cat("[[watch]]\n", key.key == "directory" ? "" : "directory = 'in'\n",
                                  key.key == "output" ? "" : "output = 'out'\n");
    write_file(path, key.table == "service" ? cat("[service]\n", line, watch) : cat(watch, line));
    try {
      load_config(path);
      ADD_FAILURE() << key.key << " is taken";
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find("unknown"), std::string::npos) << error.what();
    }
  }
}

TEST(ConfigPage, NamesOptionsOfConversionsAsKeys) {
  const std::string page = config_page("9.8.7");
  EXPECT_NE(page.find(".TH \"WEIR.TOML\" 5 \"\" \"weir 9.8.7\" \"File Formats\"\n"), std::string::npos);
  EXPECT_NE(page.find("\\fBmissing_policy\\fR\n"), std::string::npos) << page;
  EXPECT_EQ(page.find("\\fBstack\\fR"), std::string::npos);
}

TEST(ConfigPage, KeysOfAChoiceListAllValues) {
  const std::string page = config_page("9.8.7");
  for (const char* entry :
       {"\\fBsource\\fR\nkeep or delete\\-after\\-verify: what becomes of a source when its outputs are verified; "
        "default: \"keep\"\n",
        "\\fBpriority\\fR\noldest or newest: which file is converted first; default: \"oldest\"\n",
        "\\fBfollow\\fR\ninside or anywhere: where files may lie that a source names; inside: in the directory and "
        "below; default: \"inside\"\n"}) {
    EXPECT_NE(page.find(entry), std::string::npos) << entry << page;
  }
}

TEST(ConfigPage, TheDocumentListsTheEndingsThatAWatchTakes) {
  const std::string document = read_file(WEIR_SOURCE_DIR "/docs/operations.md");
  const std::size_t begin = document.find("\n* Without `include`, sources are ");
  ASSERT_NE(begin, std::string::npos);
  const std::string paragraph = document.substr(begin, document.find("\n* ", begin + 1) - begin);
  for (const SourceFormat& format : source_formats()) {
    for (const std::string_view ending : format.watched_endings) {
      EXPECT_NE(paragraph.find(cat('`', ending, '`')), std::string::npos) << ending;
    }
  }
}

// daemon/example.toml is installed as a starting point for users.
TEST(ConfigPage, TheInstalledExampleIsValid) {
  const DaemonConfig config = load_config(WEIR_SOURCE_DIR "/daemon/example.toml");
  ASSERT_EQ(config.watches.size(), 1U);
  EXPECT_EQ(config.watches[0].output, "/scratch/run42/nvdb");
  EXPECT_EQ(config.service.listen.text(), "127.0.0.1:8470");
}

}  // namespace
}  // namespace weir::config_page_test
