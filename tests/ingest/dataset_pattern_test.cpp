// Tests which datasets a pattern in --dataset matches, and the messages about the others.
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

// `label` has a type that weir does not read, `lat` is a coordinate array, and `rain` has planes over time.
TEST(DatasetPattern, VolumesWithAnObstacleAreNamed) {
  std::vector<DatasetInfo> all = datasets();
  all.resize(6);
  const auto refuse = [&](std::size_t i, const char* name, std::vector<std::int64_t> extents, const char* why) {
    all[i].name = name;
    all[i].extents = std::move(extents);
    all[i].obstacle = why;
  };
  refuse(3, "label", {2, 3, 4}, "its type is text of 3 bytes");
  refuse(4, "lat", {3}, "1 axis (3); a volume has three");
  refuse(5, "rain", {2, 3, 4}, "2 axes and time");
  all[5].over_time = true;
  const auto matches = [&](const std::string& pattern, std::vector<std::string>& said) {
    return matching_datasets("a.vti", all, pattern, {}, [&](const Message& line) { said.push_back(line.text()); });
  };
  std::vector<std::string> said;
  EXPECT_EQ(matches("*", said), (Names{"rho", "T"}));
  EXPECT_EQ(said, (Names{"a.vti: left out: label: its type is text of 3 bytes"}));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { matches("la*", said); }),
            "a.vti: --dataset la* stands for no volume: label: its type is text of 3 bytes; lat: 1 axis (3); a volume "
            "has three");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { matches("[vl]*", said); }),
            "a.vti: --dataset [vl]* stands for no volume with these options: vtkGhostType: it is read only where "
            "--dataset names it; label: its type is text of 3 bytes");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { matches("x*", said); }),
            "a.vti: no dataset's name matches x*; weir inspect lists what there is");
}

}  // namespace
}  // namespace weir::dataset_pattern_test
