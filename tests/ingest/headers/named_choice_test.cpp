// Tests how a volume is chosen by its name, and the messages that list the names.
#include "ingest/headers/named_choice.h"

#include "tests/ingest/support/scratch.h"

namespace weir::named_choice_test {
namespace {

std::string refusal(ErrorKind kind, const std::vector<NamedVolume>& there, const std::string& wanted) {
  return message_of_error(kind, [&] { choose_volume("a.vdb", "array", there, wanted); });
}

TEST(NamedChoice, TakesTheNameOrTheOnlyOneThatCanBeConverted) {
  const std::vector<NamedVolume> there{{"a", "it is a vector"}, {"b", ""}, {"", ""}};
  EXPECT_EQ(choose_volume("a.vdb", "array", there, "b"), 1U);
  EXPECT_EQ(choose_volume("a.vdb", "array", std::span(there).first(2), ""), 1U);
}

TEST(NamedChoice, RefusalListsTheNamesThereAre) {
  EXPECT_EQ(refusal(ErrorKind::input, {}, "b"), "a.vdb: holds no array");
  EXPECT_EQ(refusal(ErrorKind::input, {{"a", ""}, {"b", ""}}, "c"), "a.vdb: has no array 'c'; it has 'a', 'b'");
  EXPECT_EQ(refusal(ErrorKind::usage, {{"a", ""}, {"b", ""}, {"c", "text"}}, ""),
            "a.vdb: holds 2 arrays that can be converted; name an array with --dataset: 'a', 'b'");
  EXPECT_EQ(refusal(ErrorKind::input, {{"a", "it is text"}}, ""),
            "a.vdb: holds no array that can be converted; 'a': it is text");
  EXPECT_EQ(refusal(ErrorKind::input, {{"a", "it is text"}}, "a"), "a.vdb: array 'a' cannot be converted: it is text");
}

TEST(NamedChoice, ListsStayShort) {
  std::vector<NamedVolume> many;
  for (int i = 0; i < 30; ++i) many.push_back({std::to_string(i), ""});
  const std::string message = refusal(ErrorKind::usage, many, "");
  EXPECT_TRUE(message.ends_with("'18', '19' and 10 more")) << message;
}

TEST(NamedChoice, OfSeveralVolumes_EightAreShown) {
  std::vector<Message> choices;
  for (int i = 0; i < 10; ++i) choices.emplace_back(cat("take ", i));
  EXPECT_STREQ(several_volumes("a.h5", "volumes", 2, std::span(choices).first(2)).what(),
               "a.h5: holds 2 volumes; choose one with --dataset: take 0; take 1");
  const Error error = several_volumes("plt", "components", 12, choices);
  EXPECT_EQ(error.kind(), ErrorKind::usage);
  EXPECT_STREQ(error.what(),
               "plt: holds 12 components; choose one with --dataset: take 0; take 1; take 2; take 3; take 4; take 5; "
               "take 6; take 7; and 4 more (weir inspect lists them)");
}

}  // namespace
}  // namespace weir::named_choice_test
