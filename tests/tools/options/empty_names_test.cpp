// What an unset variable leaves of a command line is refused, and nothing is written.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/support/converted_volume.h"

namespace weir::empty_names_test {
namespace {

class EmptyNames : public ConvertedVolume {
 protected:
  void expect_refused(const std::vector<std::string>& arguments, const std::string& line) const {
    const auto before = list_directory(directory_.path());
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments.front();
    EXPECT_EQ(result.err, "weir: " + line + "\n");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(list_directory(directory_.path()), before);
  }

  std::string raw_ = directory_ / "v_40x30x20_float32.raw";
};

TEST_F(EmptyNames, Output_ExitsWith2) {
  const std::string line = "-o is empty; give a name";
  expect_refused({"convert", raw_, "-o", "", "--lossless"}, line);
  expect_refused({"sample", "cloud", "--dims", "8,8,8", "-o", ""}, line);
  expect_refused({"render", volume_, "-o", ""}, line);
  expect_refused({"play", volume_, "-o", ""}, line);
  expect_refused({"export", volume_, "-o", ""}, line);
  expect_refused({"sweep", raw_, "-o", ""}, line);
  expect_refused({"flip", "a.png", "b.png", "-o", ""}, line);
}

TEST_F(EmptyNames, Input_ExitsWith2) {
  expect_refused({"convert", ""}, "the argument input is empty; give a name");
  expect_refused({"convert", raw_, ""}, "the argument input is empty; give a name");
  expect_refused({"inspect", ""}, "the argument volume is empty; give a name");
  expect_refused({"verify", ""}, "the argument volume is empty; give a name");
  expect_refused({"compare", "", volume_}, "the argument input is empty; give a name");
}

}  // namespace
}  // namespace weir::empty_names_test
