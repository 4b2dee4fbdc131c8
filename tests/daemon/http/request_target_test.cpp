#include "daemon/http/request_target.h"

#include <gtest/gtest.h>

#include "format/base/text.h"

namespace weir::request_target_test {
namespace {

using Path = std::vector<std::string>;
using Query = std::map<std::string, std::string>;

TEST(RequestTarget, SplitsAndDecodesPaths) {
  EXPECT_EQ(parse_target("/")->path, Path{});
  EXPECT_EQ(parse_target("/api/jobs/7")->path, (Path{"api", "jobs", "7"}));
  EXPECT_EQ(parse_target("/api//jobs/")->path, (Path{"api", "", "jobs", ""}));
  EXPECT_EQ(parse_target("/a%2Fb/%c3%A4+")->path, (Path{"a/b", "\xc3\xa4+"}));
  EXPECT_EQ(parse_target("/../etc")->path, (Path{"..", "etc"}));
}

TEST(RequestTarget, SplitsAndDecodesQueries) {
  EXPECT_EQ(parse_target("/a")->query, Query{});
  EXPECT_EQ(parse_target("/a?")->query, Query{});
  EXPECT_EQ(parse_target("/?x=1")->path, Path{});
  EXPECT_EQ(parse_target("/a?x=1&y=%2Fscratch%2Frun+42&z&&")->query,
            (Query{{"x", "1"}, {"y", "/scratch/run 42"}, {"z", ""}}));
  EXPECT_EQ(parse_target("/a?x=1=2?3")->query, (Query{{"x", "1=2?3"}}));
}

TEST(RequestTarget, RefusesMalformedTargets) {
  for (const char* target : {"", "*", "api", "http://localhost/api", "/%", "/%4", "/%4g", "/%-1", "/a?x=%zz", "/a?%=1",
                             "/a?x=1&y&x=2", "/a?x=1&%78=1"}) {
    EXPECT_FALSE(parse_target(target)) << target;
  }
}

TEST(RequestTarget, DecodesWhatItEncoded) {
  std::string every;
  for (int byte = 0; byte < 256; ++byte) every += static_cast<char>(byte);
  EXPECT_EQ(percent_encode("/a b+~"), "%2Fa%20b%2B~");
  EXPECT_EQ(parse_target(cat("/a?x=", percent_encode(every)))->query.at("x"), every);
  EXPECT_EQ(parse_target(cat("/", percent_encode(every)))->path, Path{every});
}

}  // namespace
}  // namespace weir::request_target_test
