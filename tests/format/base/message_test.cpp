#include "format/base/message.h"

#include <gtest/gtest.h>

namespace weir::message_test {
namespace {

TEST(Message, TextOfACommandLine_IsShownThereAlone) {
  const Message line = compose("choose one with ", option("dataset"), ": ",
                               CommandLineText{"weir convert a.nc --dataset '/a b'", "dataset /a b"}, " (2 x 3)");
  EXPECT_EQ(line.text(), "choose one with --dataset: weir convert a.nc --dataset '/a b' (2 x 3)");
  EXPECT_EQ(line.worded(key_wording), "choose one with dataset: dataset /a b (2 x 3)");
}

TEST(Message, Remark_IsTheSameLine) {
  const Message line = compose("lossless in ", 5, " bytes");
  EXPECT_FALSE(line.is_remark());
  EXPECT_TRUE(line.as_remark().is_remark());
  EXPECT_EQ(line.as_remark().text(), line.text());
}

TEST(Message, PackedForAnotherProcess_IsWordedThere) {
  const Message line = compose("NaN at 1; choose ", option("nonfinite", "keep"), " or ", option("background"), ": ",
                               CommandLineText{"weir convert a", "a"});
  const Message there = Message::unpack(line.packed());
  EXPECT_EQ(there.text(), line.text());
  EXPECT_EQ(there.worded(key_wording), "NaN at 1; choose nonfinite keep or background: a");
  EXPECT_TRUE(Message::unpack("").empty());
}

}  // namespace
}  // namespace weir::message_test
