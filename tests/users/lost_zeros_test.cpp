// Tests the reported number of exact zeros that a lossy file does not keep. The volume is a cloud in clear air, with
// mostly zeros.
#include "tests/users/user_script.h"

namespace weir::lost_zeros_test {
namespace {

class LostZeros : public UserScript {};

TEST_F(LostZeros, AreSaidByConvertInspectAndCompare) {
  ASSERT_EQ(weir({"sample", "cloud", "-o", "c_96x80x64_float32.raw"}).exit_code, 0);
  const CommandResult made =
      weir({"convert", "c_96x80x64_float32.raw", "--rate", "100", "--encoding", "packed", "-o", "c.nvdb", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto zeros = nlohmann::json::parse(made.out)["zeros"];
  ASSERT_GT(zeros["lost"], 0);
  const auto count = [&](const char* key) { return std::to_string(zeros[key].get<std::uint64_t>()); };
  const std::string said = count("lost") + " of " + count("count") + " zeros (";
  EXPECT_NE(made.err.find(" of the range), " + said), std::string::npos) << made.err;
  EXPECT_NE(made.err.find(" %) lost, "), std::string::npos) << made.err;
  const std::string shown = weir({"inspect", "c.nvdb"}).out;
  EXPECT_NE(shown.find("\nzeros       " + said), std::string::npos) << shown;
  const std::string compared = weir({"compare", "c_96x80x64_float32.raw", "c.nvdb"}).out;
  EXPECT_NE(compared.find("\nzeros      " + said), std::string::npos) << compared;
  const auto report = nlohmann::json::parse(weir({"compare", "c_96x80x64_float32.raw", "c.nvdb", "--json"}).out);
  EXPECT_EQ(report["zeros"], zeros["count"]);
  EXPECT_EQ(report["zeros_lost"], zeros["lost"]);
}

TEST_F(LostZeros, ThatAreNoneAreNotSpokenOf) {
  ASSERT_EQ(weir({"sample", "cloud", "-o", "c_96x80x64_float32.raw"}).exit_code, 0);
  const CommandResult made = weir({"convert", "c_96x80x64_float32.raw", "--lossless", "-o", "c.nvdb"});
  EXPECT_EQ(made.err.find("zeros"), std::string::npos) << made.err;
  EXPECT_EQ(weir({"inspect", "c.nvdb"}).out.find("\nzeros"), std::string::npos);
  EXPECT_EQ(weir({"compare", "c_96x80x64_float32.raw", "c.nvdb"}).out.find("zeros"), std::string::npos);
}

}  // namespace
}  // namespace weir::lost_zeros_test
