// The planes of a stack lie where their files say, whatever the order of the files.
#include "ingest/raw/stack_placement.h"

#include <array>

#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"

namespace weir::stack_placement_test {
namespace {

using Triple = std::array<double, 3>;

/// Writes an NRRD file of 2 x 1 x `planes` voxels of `value`. The centre of the first voxel lies at `origin`.
void write_nrrd(const Scratch& scratch, const std::string& name, float value, int planes, const Triple& origin,
                const std::string& directions = "(1,0,0) (0,1,0) (0,0,0.5)") {
  std::string text = "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 1 " + std::to_string(planes) +
                     "\nspace: right-anterior-superior\nspace directions: " + directions + "\nspace origin: (" +
                     std::to_string(origin[0]) + "," + std::to_string(origin[1]) + "," + std::to_string(origin[2]) +
                     ")\nencoding: raw\nendian: little\n\n";
  const std::vector<float> values(static_cast<std::size_t>(2 * planes), value);
  text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  scratch.write_values(name, std::vector<char>(text.begin(), text.end()));
}

class StackPlacement : public ::testing::Test {
 protected:
  std::unique_ptr<VolumeSource> open(const std::optional<Triple>& spacing = {}) {
    SourceOptions options;
    options.stack = true;
    options.spacing = spacing;
    return open_source(scratch_.path("s_%d.nrrd"), options);
  }
  std::vector<float> along_z(VolumeSource& source) {
    const Index3 e = source.info().extent;
    std::vector<float> values(static_cast<std::size_t>(e.z));
    source.read({{0, 0, 0}, {1, 1, e.z}}, values);
    return values;
  }
  std::string refused() {
    return message_of_error(ErrorKind::input, [&] { open(); });
  }

  Scratch scratch_;
};

TEST_F(StackPlacement, SlabsThatFollowEachOther_AreOneAxis) {
  write_nrrd(scratch_, "s_0.nrrd", 1, 2, {10, 20, 30});
  write_nrrd(scratch_, "s_1.nrrd", 2, 3, {10, 20, 31});
  const auto source = open();
  EXPECT_EQ(source->info().spacing, (Triple{1, 1, 0.5}));
  EXPECT_EQ(source->info().origin, (Triple{10, 20, 30}));
  EXPECT_EQ(along_z(*source), (std::vector<float>{1, 1, 2, 2, 2}));
}

TEST_F(StackPlacement, SinglePlanes_GiveTheSpacing) {
  for (int i = 0; i < 4; ++i)
    write_nrrd(scratch_, "s_" + std::to_string(i) + ".nrrd", static_cast<float>(i), 1, {0, 0, 5 + 2.5 * i});
  const auto source = open();
  EXPECT_EQ(source->info().spacing[2], 2.5);
  EXPECT_EQ(source->info().origin[2], 5);
  EXPECT_EQ(along_z(*source), (std::vector<float>{0, 1, 2, 3}));
}

TEST_F(StackPlacement, SinglePlanesThatFall_AreReadFromTheLastToTheFirst) {
  for (int i = 0; i < 4; ++i)
    write_nrrd(scratch_, "s_" + std::to_string(i) + ".nrrd", static_cast<float>(i), 1, {0, 0, 100 - 2.5 * i});
  const auto source = open();
  EXPECT_EQ(source->info().spacing[2], 2.5);
  EXPECT_EQ(source->info().origin[2], 92.5);
  EXPECT_TRUE(source->info().details.axes[2].reversed);
  EXPECT_EQ(source->info().details.axes[2].note,
            "falls from 100 to 92.5: planes are read in reverse order, so that positions rise");
  EXPECT_EQ(along_z(*source), (std::vector<float>{3, 2, 1, 0}));
}

TEST_F(StackPlacement, WithSpacing_FilesAreTakenAsTheyAre) {
  for (int i = 0; i < 3; ++i) {
    write_nrrd(scratch_, "s_" + std::to_string(i) + ".nrrd", static_cast<float>(i), 1, {0, 0, 3.0 - i});
  }
  const auto source = open(Triple{1, 1, 1});
  EXPECT_EQ(along_z(*source), (std::vector<float>{0, 1, 2}));
  EXPECT_EQ(source->info().origin[2], 3);
  EXPECT_FALSE(source->info().details.axes[2].reversed);
}

TEST_F(StackPlacement, PlanesThatFallWithGaps_AreNotTurnedRound) {
  const std::array<double, 3> z{9, 4, 1};
  for (int i = 0; i < 3; ++i) {
    write_nrrd(scratch_, "s_" + std::to_string(i) + ".nrrd", static_cast<float>(i), 1,
               {0, 0, z[static_cast<std::size_t>(i)]});
  }
  const auto source = open();
  EXPECT_EQ(along_z(*source), (std::vector<float>{0, 1, 2}));
  EXPECT_EQ(source->info().details.axes[2].coordinates, (std::vector<double>{9, 4, 1}));
  EXPECT_EQ(source->info().details.axes[2].note, "irregular coordinates from 9 to 1, taken as indices");
}

TEST_F(StackPlacement, PlanesOfNearlyOnePlace_AreStackedByTheirNames) {
  for (int i = 0; i < 3; ++i) {
    write_nrrd(scratch_, "s_" + std::to_string(i) + ".nrrd", static_cast<float>(i), 2, {0, 0, i == 1 ? 1e-6 : 0});
  }
  EXPECT_EQ(along_z(*open()), (std::vector<float>{0, 0, 1, 1, 2, 2}));
}

TEST_F(StackPlacement, AxesThatFallOrLieAcross_AreThoseOfTheFirstFile) {
  const auto write = [&](const std::string& directions, const Triple& second) {
    write_nrrd(scratch_, "s_0.nrrd", 1, 2, {0, 0, 9}, directions);
    write_nrrd(scratch_, "s_1.nrrd", 2, 2, second, directions);
  };
  write("(1,0,0) (0,1,0) (0,0,-1)", {0, 0, 7});
  EXPECT_EQ(along_z(*open()), (std::vector<float>{1, 1, 2, 2}));
  EXPECT_EQ(open()->info().spacing[2], 1);
  write("(1,0,0) (0,.8,.6) (0,-.6,.8)", {0, -1.2, 10.6});
  EXPECT_EQ(along_z(*open()), (std::vector<float>{1, 1, 2, 2}));
  write_nrrd(scratch_, "s_1.nrrd", 2, 2, {0, 0, 9});
  EXPECT_TRUE(refused().find(": orientation \"\" differs from \"axes") != std::string::npos) << refused();
}

TEST_F(StackPlacement, PlanesWithGaps_KeepTheirCoordinates) {
  const std::array<double, 4> z{0, 1, 3, 7};
  for (int i = 0; i < 4; ++i)
    write_nrrd(scratch_, "s_" + std::to_string(i) + ".nrrd", 0, 1, {0, 0, z[static_cast<std::size_t>(i)]});
  const auto source = open();
  EXPECT_EQ(source->info().spacing[2], 0.5) << "what the files say of one plane";
  EXPECT_EQ(source->info().details.axes[2].coordinates, (std::vector<double>{0, 1, 3, 7}));
  EXPECT_EQ(source->info().details.axes[2].note, "irregular coordinates from 0 to 7, taken as indices");
}

TEST_F(StackPlacement, FilesOfOnePlace_AreStackedByTheirNames) {
  write_nrrd(scratch_, "s_0.nrrd", 1, 2, {10, 20, 30});
  write_nrrd(scratch_, "s_1.nrrd", 2, 2, {10, 20, 30});
  EXPECT_EQ(open()->info().origin, (Triple{10, 20, 30}));
}

TEST_F(StackPlacement, FilesElsewhere_AreRefusedUnlessSpacingIsGiven) {
  write_nrrd(scratch_, "s_0.nrrd", 1, 2, {10, 20, 30});
  const std::string path = scratch_.path("s_1.nrrd");
  const std::string end = " of " + scratch_.path("s_0.nrrd") +
                          "; a stack's files must be alike, or give --spacing to take them as they are";
  write_nrrd(scratch_, "s_1.nrrd", 2, 2, {10, 21, 31});
  EXPECT_EQ(refused(), path + ": origin along y 21 differs from 20" + end);
  write_nrrd(scratch_, "s_1.nrrd", 2, 2, {10, 20, 31}, "(2,0,0) (0,1,0) (0,0,0.5)");
  EXPECT_EQ(refused(), path + ": spacing along x 2 differs from 1" + end);
  write_nrrd(scratch_, "s_1.nrrd", 2, 2, {10, 20, 29});
  EXPECT_EQ(refused(), path + ": its plane at z = 29 is not above the one before it, at 30.5 in " +
                           scratch_.path("s_0.nrrd") +
                           "; rename the files, or give --spacing to take them as they are");
  const auto source = open(Triple{1, 1, 4});
  EXPECT_EQ(source->info().spacing[2], 4);
  EXPECT_EQ(along_z(*source), (std::vector<float>{1, 1, 2, 2}));
}

TEST_F(StackPlacement, ReversedPlanes_AreOfTheLastFileFirst) {
  const auto falling = [](const std::string& path) {
    StackedPlanes planes;
    planes.path = path;
    planes.count = 8;
    planes.reversed = true;
    return planes;
  };
  StackedPlanes rising = falling("c");
  rising.reversed = false;
  EXPECT_TRUE(stacked_backwards({falling("a"), falling("b")}, false));
  EXPECT_EQ(
      message_of_error(ErrorKind::input,
                       [&] {
                         stacked_backwards({rising, falling("b")}, true);
                       }),
      "b: its planes are read in reverse order, since their coordinates fall, and those of other files of the stack "
      "are not; a stack's files must be alike");
}

}  // namespace
}  // namespace weir::stack_placement_test
