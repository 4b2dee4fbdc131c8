#include "ingest/dataset_pattern.h"

#include <gtest/gtest.h>

#include "tests/support/message_of_error.h"

namespace weir::dataset_pattern_test {
namespace {

std::vector<DatasetInfo> datasets() {
  std::vector<DatasetInfo> all(3);
  all[0].name = "rho";
  all[1].name = "vtkGhostType";
  all[1].by_name_only = true;
  all[2].name = "T";
  return all;
}

std::vector<std::string> matching(const std::string& pattern, std::vector<std::string>* said = nullptr) {
  return matching_datasets("a.vti", datasets(), pattern, {}, [&](const Message& line) {
    if (said != nullptr) said->push_back(line.text());
  });
}

using Names = std::vector<std::string>;

TEST(DatasetPattern, LeavesOutWhatIsReadByNameOnly) {
  std::vector<std::string> said;
  EXPECT_EQ(matching("*", &said), (Names{"rho", "T"}));
  EXPECT_EQ(said, Names{});
  EXPECT_EQ(matching("vtkGhostType"), (Names{"vtkGhostType"}));
}

TEST(DatasetPattern, OfNothingButThoseIsAnErrorThatSaysWhy) {
  EXPECT_EQ(message_of_error(ErrorKind::usage, [] { matching("vtk*"); }),
            "a.vti: --dataset vtk* stands for no volume with these options: vtkGhostType: it is read only where "
            "--dataset names it");
}

}  // namespace
}  // namespace weir::dataset_pattern_test
