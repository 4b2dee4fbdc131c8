#include "format/base/toml_reader.h"

#include <gtest/gtest.h>

#include "tests/support/message_of_error.h"

namespace weir::toml_reader_test {
namespace {

const std::string kPath = "f.toml";

/// The message of reading `key` of `text` as a Value; empty: it went well.
template <typename Value>
std::string refusal(const std::string& text, const std::string& key) {
  const toml::table table = parse_toml(text, kPath);
  Value value{};
  try {
    TomlReader(table, "the file", kPath).read(key, value);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
}

TEST(TomlReader, ReadsPresentKeysAndKeepsValuesOfAbsentOnes) {
  const toml::table table = parse_toml("a = true\nb = ['x', '']\nc = 'text'\nd = 2\ne = [1, 2.5]\n", kPath);
  TomlReader reader(table, "the file", kPath);
  bool a = false;
  std::vector<std::string> b{"old"};
  std::string c;
  double d = 0;
  std::array<double, 2> e{};
  EXPECT_TRUE(reader.read("a", a));
  EXPECT_TRUE(reader.read("b", b));
  EXPECT_TRUE(reader.read("c", c));
  EXPECT_TRUE(reader.read("d", d));
  EXPECT_TRUE(reader.read("e", e));
  EXPECT_TRUE(a);
  EXPECT_EQ(b, (std::vector<std::string>{"x", ""}));
  EXPECT_EQ(c, "text");
  EXPECT_EQ(d, 2);
  EXPECT_EQ(e, (std::array<double, 2>{1, 2.5}));
  EXPECT_FALSE(reader.read("absent", a));
  EXPECT_FALSE(reader.read("absent", b));
  EXPECT_TRUE(a);
  EXPECT_EQ(b.size(), 2U);
  EXPECT_NO_THROW(reader.finish());
}

TEST(TomlReader, WrongTypeIsRefusedWithLineAndColumn) {
  EXPECT_EQ(refusal<bool>("\n  a = 1", "a"), "f.toml:2:7: a must be true or false");
  EXPECT_EQ(refusal<std::vector<std::string>>("a = 'x'", "a"), "f.toml:1:5: a must be an array of strings");
  EXPECT_EQ(refusal<std::vector<std::string>>("a = ['x', 2]", "a"), "f.toml:1:11: a must be an array of strings");
  EXPECT_EQ(refusal<std::string>("a = true", "a"), "f.toml:1:5: a must be a string");
  EXPECT_EQ(refusal<double>("a = 'x'", "a"), "f.toml:1:5: a is \"x\", it must be a number");
  EXPECT_EQ(refusal<double>("a = true", "a"), "f.toml:1:5: a is true, it must be a number");
  EXPECT_EQ(refusal<double>("a = [1]", "a"), "f.toml:1:5: a is an array, it must be a number");
  EXPECT_EQ(refusal<double>("a = {}", "a"), "f.toml:1:5: a is a table, it must be a number");
  EXPECT_EQ(refusal<double>("a = 1979-05-27", "a"), "f.toml:1:5: a is a date or a time, it must be a number");
}

TEST(TomlReader, TextThatIsNoToml_IsRefusedInOneLineWithItsPlace) {
  EXPECT_EQ(message_of_error(ErrorKind::input, [] { parse_toml("[camera\n", kPath); }),
            "f.toml:1:8: Error while parsing table header: expected ']', saw '\\n'; correct the TOML there");
}

TEST(TomlReader, UnknownKeyIsRefusedByName) {
  const toml::table table = parse_toml("a = 1\nb = 2\n", kPath);
  TomlReader reader(table, "[t]", kPath);
  reader.find("a");
  try {
    reader.finish();
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "f.toml:2:1: unknown key \"b\" in [t]; there are a");
  }
}

TEST(TomlReader, UnknownKeyThatIsNearlyAKnownOne_IsSaidToBeMeantAsThat) {
  const toml::table table = parse_toml("siez = 1\n", kPath);
  TomlReader reader(table, "[t]", kPath);
  for (const char* known : {"rate", "size"}) reader.find(known);
  try {
    reader.finish();
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "f.toml:1:1: unknown key \"siez\" in [t]; there are rate, size; did you mean size?");
  }
}

}  // namespace
}  // namespace weir::toml_reader_test
