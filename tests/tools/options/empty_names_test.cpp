// Tests command lines in which an unset shell variable left an empty name. They are refused, and nothing is written.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "format/base/text.h"
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

// Without this check, the parser would take the next word for the value.
TEST_F(EmptyNames, ValueBehindAnEqualsSign_ExitsWith2) {
  const auto line = [](const char* name) {
    return cat("--", name, "= has nothing behind it; give a value, or leave it out");
  };
  expect_refused({"convert", raw_, "--output=", "--lossless"}, line("output"));
  expect_refused({"convert", raw_, "--lossless", "--output="}, line("output"));
  expect_refused({"convert", "--work-dir=", raw_, "-o", directory_ / "o.nvdb"}, line("work-dir"));
  expect_refused({"convert", "--overwrite=", raw_, "-o", directory_ / "o.nvdb"}, line("overwrite"));
  expect_refused({"render", volume_, "--output=", "a.png"}, line("output"));
  expect_refused({"inspect", volume_, "--plot=", "--json"}, line("plot"));
}

TEST_F(EmptyNames, ShortNameWithAnEqualsSign_ExitsWith2) {
  expect_refused({"convert", raw_, "-o=a.nvdb", "--lossless"},
                 "-o=a.nvdb is read as the name =a.nvdb; write -o NAME or --output=NAME");
}

TEST_F(EmptyNames, FileThatEndsInAnEqualsSign_IsTaken) {
  const CommandResult result = run_weir({"verify", "--", "--output="});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "weir: --output=: cannot open: No such file or directory; check the name and the current directory\n");
}

}  // namespace
}  // namespace weir::empty_names_test
