// Tests the source of a plotfile: its description, the paths that name it, and the plotfiles that are refused.
#include "ingest/amrex/amrex_source.h"

#include <sys/stat.h>

#include <atomic>
#include <filesystem>

#include "ingest/series.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/plotfile_writer.h"
#include "tests/support/run_command.h"

namespace weir::amrex_source_test {
namespace {

using test::PlotfilePlan;

/// Returns the plan of two components on two levels, with boxes in several files.
PlotfilePlan two_levels() {
  PlotfilePlan plan;
  plan.components = {"density", "Temp"};
  plan.domain = {{0, 0, 0}, {8, 8, 8}};
  plan.ratios = {{2, 2, 2}};
  plan.boxes = {{{{0, 0, 0}, {8, 8, 4}}, {{0, 0, 4}, {8, 8, 8}}}, {{{2, 2, 2}, {8, 8, 8}}, {{8, 2, 2}, {12, 8, 8}}}};
  plan.fabs_per_file = 1;
  plan.corner = {-1, 0, 10};
  plan.spacing = {0.5, 0.25, 2};
  plan.time = 1.5;
  return plan;
}

SourceOptions named(const std::string& component) {
  SourceOptions options;
  options.dataset = component;
  return options;
}

class AmrexSource : public testing::Test {
 protected:
  AmrexSource() { test::write_plotfile(path_, two_levels()); }

  std::string file(const std::string& name) const { return path_ + '/' + name; }

  void replace(const std::string& name, const std::string& what, const std::string& by) const {
    std::string text = read_file(file(name));
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
    write_file(file(name), text);
  }

  /// Returns the message of the error that opening and reading the whole volume throws, without the path of the
  /// plotfile and the slash or colon after it.
  std::string refusal(ErrorKind kind = ErrorKind::input, SourceOptions options = named("density")) const {
    const std::string message = message_of_error(kind, [&] {
      const auto source = open_source(path_, options);
      std::vector<float> values(static_cast<std::size_t>(source->info().domain().voxels()));
      source->read(source->info().domain(), values);
    });
    EXPECT_TRUE(message.starts_with(path_)) << message;
    return message.substr(std::min(message.size(), path_.size() + 1));
  }

  Scratch scratch_;
  std::string path_ = scratch_.path("plt00042");
};

TEST_F(AmrexSource, InfoIsThatOfTheLevel) {
  const auto finest = open_source(path_, named("Temp"));
  const SourceInfo& info = finest->info();
  EXPECT_EQ(info.path, path_);
  EXPECT_EQ(info.format, "amrex");
  EXPECT_EQ(info.dataset, "Temp");
  EXPECT_EQ(info.extent, (Index3{16, 16, 16}));
  EXPECT_EQ(info.type, ScalarType::float64);
  EXPECT_EQ(info.spacing, (std::array<double, 3>{0.25, 0.125, 1}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{-0.875, 0.0625, 10.5}));
  EXPECT_EQ(info.details.time->value, 1.5);
  EXPECT_EQ(info.files.size(), 7U);
  EXPECT_FALSE(info.files_digest.empty());
  std::uint64_t bytes = 0;
  for (const FileState& state : info.files) bytes += state.bytes;
  EXPECT_EQ(info.file_bytes, bytes);

  SourceOptions options = named("Temp");
  options.level = 0;
  const auto coarse = open_source(path_, options);
  EXPECT_EQ(coarse->info().extent, (Index3{8, 8, 8}));
  EXPECT_EQ(coarse->info().spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  EXPECT_EQ(coarse->info().origin, (std::array<double, 3>{-0.75, 0.125, 11}));
}

TEST_F(AmrexSource, ListHasComponentsLevelsAndRanges) {
  const std::vector<DatasetInfo> list = format_of(path_).list(path_, {});
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].name, "density");
  EXPECT_EQ(list[1].name, "Temp");
  EXPECT_EQ(list[0].extents, (std::vector<std::int64_t>{16, 16, 16}));
  EXPECT_EQ(list[0].type, "float64");
  EXPECT_EQ(list[0].layout, "2 levels of 2 and 2 boxes, refined by 2");
  using Attributes = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(
      list[0].attributes,
      (Attributes{
          {"range", "0 .. 1055909"}, {"spacing", "0.25,0.125,1"}, {"origin", "-0.875,0.0625,10.5"}, {"time", "1.5"}}));
}

TEST_F(AmrexSource, ExtentThatNoVolumeHas_IsListedAsTheReason) {
  PlotfilePlan plan;
  plan.domain = {{0, 0, 0}, {2048, 1, 1}};
  plan.ratios = {{1024, 1, 1}, {1024, 1, 1}};
  plan.boxes = {{plan.domain}, {{{0, 0, 0}, {8, 1, 1}}}, {{{0, 0, 0}, {8, 1, 1}}}};
  path_ = scratch_.path("long");
  test::write_plotfile(path_, plan);
  const std::string obstacle = "extent 2147483648x1x1 has 2147483648 voxels along x; each axis must be 1 to 2147483647";
  EXPECT_EQ(format_of(path_).list(path_, {})[0].obstacle, obstacle);
  EXPECT_EQ(refusal(ErrorKind::input, {}), " " + obstacle);
  SourceOptions options;
  options.level = 1;
  EXPECT_EQ(format_of(path_).list(path_, options)[0].obstacle, "");
}

TEST_F(AmrexSource, ASlashAtTheEnd_AndItsHeader_NameIt) {
  for (const std::string& name : {path_ + "/", path_ + "//", path_ + "/Header"}) {
    const auto source = open_source(name, named("density"));
    EXPECT_EQ(source->info().format, "amrex");
    EXPECT_EQ(source->info().extent, (Index3{16, 16, 16}));
    EXPECT_EQ(expand_series(std::vector{name}, named("density")).front().stem, "plt00042") << name;
  }
}

TEST_F(AmrexSource, PatternsNamePlotfilesOfASeries) {
  test::write_plotfile(scratch_.path("plt00100"), two_levels());
  test::write_plotfile(scratch_.path("run.2.plt00100"), two_levels());
  for (const std::string& pattern : {scratch_.path("plt*"), scratch_.path("plt*/"), scratch_.path("plt%05d")}) {
    const auto steps = expand_series(std::vector{pattern}, named("*"));
    ASSERT_EQ(steps.size(), 4U) << pattern;
    EXPECT_EQ(steps[0].path, path_);
    EXPECT_EQ(steps[1].dataset, "Temp");
    EXPECT_EQ(steps[2].path, scratch_.path("plt00100"));
    EXPECT_EQ(steps[2].stem, "plt00100");
  }
  EXPECT_EQ(expand_series(std::vector{scratch_.path("run.2.plt00100")}, {}).front().stem, "run.2.plt00100");
}

TEST_F(AmrexSource, WithoutADataset_TheCommandsAreListed) {
  EXPECT_EQ(refusal(ErrorKind::usage, {}), " holds 2 components; choose one with --dataset: weir convert " + path_ +
                                               " --dataset density; weir convert " + path_ + " --dataset Temp");
  EXPECT_EQ(refusal(ErrorKind::input, named("rho")), " has no component 'rho'; it has 'density', 'Temp'");
}

TEST_F(AmrexSource, LevelsThatAreNotThere_AreRefused) {
  SourceOptions options = named("density");
  options.level = 2;
  EXPECT_EQ(refusal(ErrorKind::usage, options), " --level 2 is none of its levels; give 0, the coarsest, to 1");
  options.level.reset();
  options.index = {0};
  EXPECT_EQ(refusal(ErrorKind::usage, options), " --index is for arrays of more than three axes; leave it out");
}

TEST_F(AmrexSource, OtherDimensionsAndCoordinates_AreRefused) {
  replace("Header", "Temp\n3\n", "Temp\n2\n");
  EXPECT_EQ(refusal(), "Header: line 5: the plotfile is 2-D; only plotfiles of three dimensions can be read");
  replace("Header", "Temp\n2\n", "Temp\n3\n");
  replace("Header", "\n0\n0\n0 2", "\n1\n0\n0 2");
  EXPECT_EQ(refusal(), "Header: line 15: the coordinates are cylindrical; only Cartesian ones can be read");
}

TEST_F(AmrexSource, MissingFiles_AreNamed) {
  std::filesystem::rename(file("Level_1/Cell_D_00001"), file("gone"));
  EXPECT_EQ(refusal(), "Level_1/Cell_D_00001: cannot open for reading: No such file or directory; " +
                           file("Level_1/Cell_H") + " has FABs in it");
  std::filesystem::remove(file("Level_0/Cell_H"));
  EXPECT_EQ(refusal(), "Level_0/Cell_H: cannot open for reading: No such file or directory");
}

TEST_F(AmrexSource, CutFiles_AreRefusedBeforeAnyValueIsRead) {
  std::filesystem::resize_file(file("Level_0/Cell_D_00001"), 4000);
  EXPECT_EQ(refusal(),
            "Level_0/Cell_D_00001: has 4000 bytes, and the FAB at offset 0 ends at 4182; the file is cut, or "
            "not written to its end");
  std::filesystem::resize_file(file("Level_0/Cell_D_00001"), 20);
  EXPECT_EQ(refusal(),
            "Level_0/Cell_D_00001: offset 0: 'FAB ((8, (64 11 52 0' should be the header of a FAB; Cell_H is "
            "of other files, or these are damaged");
}

TEST_F(AmrexSource, OffsetsBehindTheEnd_AreRefused) {
  replace("Level_0/Cell_H", "Cell_D_00001 0", "Cell_D_00001 99999999999");
  EXPECT_EQ(refusal(),
            "Level_0/Cell_D_00001: has 4182 bytes, and the FAB at offset 99999999999 ends at 100000000000; the "
            "file is cut, or not written to its end");
  replace("Level_0/Cell_H", "Cell_D_00001 99999999999", "Cell_D_00001 -8");
  EXPECT_EQ(refusal(), "Level_0/Cell_H: line 11: a FAB at offset -8 is impossible; the header is damaged");
}

TEST_F(AmrexSource, FabsWithoutHeadersThatShareBytes_AreRefused) {
  for (const int version : {2, 3, 4}) {
    PlotfilePlan plan = two_levels();
    plan.version = version;
    plan.fabs_per_file = 2;
    path_ = scratch_.path("bare" + std::to_string(version));
    test::write_plotfile(path_, plan);
    EXPECT_EQ(open_source(path_, named("density"))->info().extent, (Index3{16, 16, 16}));
    for (const std::string offset : {"0", "4", "4095"}) {
      replace("Level_0/Cell_H", "Cell_D_00000 4096\n", "Cell_D_00000 " + offset + "\n");
      EXPECT_EQ(refusal(), "Level_0/Cell_D_00000: the FABs at offsets 0 and " + offset +
                               " have bytes in common: the first ends at 4096; " + file("Level_0/Cell_H") +
                               " is damaged");
      test::write_plotfile(path_, plan);
    }
  }
}

TEST_F(AmrexSource, FabsWithoutHeaders_LieInAnyOrderInTheirFile) {
  PlotfilePlan plan = two_levels();
  plan.version = 2;
  plan.fabs_per_file = 2;
  test::write_plotfile(path_, plan);
  replace("Level_0/Cell_H", "Cell_D_00000 0\nFabOnDisk: Cell_D_00000 4096\n",
          "Cell_D_00000 4096\nFabOnDisk: Cell_D_00000 0\n");
  EXPECT_EQ(open_source(path_, named("density"))->info().extent, (Index3{16, 16, 16}));
}

TEST_F(AmrexSource, FabsOfAnotherBox_AreRefusedWhereTheyAreRead) {
  replace("Level_0/Cell_D_00000", "((0,0,0) (7,7,3) (0,0,0)) 2", "((0,0,0) (7,3,7) (0,0,0)) 2");
  EXPECT_EQ(refusal(),
            "Level_0/Cell_D_00000: offset 0: a FAB of 2 components of float64 in 0:8,0:4,0:8, and 2 "
            "components of float64 in 0:8,0:8,0:4 belong there; Cell_H is of other files, or these are "
            "damaged");
}

TEST_F(AmrexSource, DomainsThatAreNotCovered_AreRefused) {
  replace("Level_0/Cell_H", "((0,0,4) (7,7,7)", "((0,0,4) (7,7,6)");
  EXPECT_EQ(refusal(),
            "Level_0/Cell_H: the boxes of level 0 cover 448 of the 512 cells of its domain, and must cover "
            "all; write the plotfile of the whole domain");
  replace("Level_0/Cell_H", "((0,0,4) (7,7,6)", "((0,0,3) (7,7,7)");
  EXPECT_EQ(refusal(),
            "Level_0/Cell_H: boxes 0 and 1, (0,0,0) to (7,7,3) and (0,0,3) to (7,7,7), have cells in common; "
            "the header is damaged");
  replace("Level_0/Cell_H", "((0,0,3) (7,7,7)", "((0,0,4) (7,7,8)");
  EXPECT_EQ(refusal(),
            "Level_0/Cell_H: box (0,0,4) to (7,7,8) reaches outside the level's domain, (0,0,0) to (7,7,7); "
            "the header is damaged");
}

TEST_F(AmrexSource, HeadersThatContradictEachOther_AreRefused) {
  replace("Level_1/Cell_H", "1\n1\n2\n0\n", "1\n1\n3\n0\n");
  EXPECT_EQ(refusal(),
            "Level_1/Cell_H: line 13: the table of the boxes' minima and maxima has 2 rows of 2, and there "
            "are 2 boxes and 3 components; the header is damaged");
  replace("Level_1/Cell_H", "1\n1\n3\n0\n", "1\n1\n2\n0\n");
  replace("Header", "\n2 \n((0,0,0)", "\n4 \n((0,0,0)");
  EXPECT_EQ(refusal(),
            "Header: line 11: the ratio of level 1 to level 0 is said to be 4, and (2,2,2) by their domains; "
            "the header is damaged");
}

TEST_F(AmrexSource, SizesOfCellsThatDoNotFit_AreRefused) {
  replace("Header", "\n0.25 0.125 1 \n", "\n0.5 0.25 2 \n");
  EXPECT_EQ(refusal(),
            "Header: line 14: the size of level 1's cells along x is 0.5, and must be 0.25, that of level 0, 0.5, by "
            "the ratio 2; the header is damaged");
}

TEST_F(AmrexSource, TwoComponentsOfOneName_AreRefused) {
  replace("Header", "\nTemp\n", "\ndensity\n");
  EXPECT_EQ(refusal(),
            " its components 1 and 2 of 2 both have the name 'density', which does not say which of them is meant; "
            "give one of them another name in its Header");
  for (const DatasetInfo& component : format_of(path_).list(path_, {})) {
    EXPECT_EQ(component.obstacle, "another component has the same name");
  }
  EXPECT_EQ(refusal(ErrorKind::usage, {}),
            " holds 2 components; choose one with --dataset: none has a name of its own (weir inspect lists them)");
}

TEST_F(AmrexSource, Header_ThatIsAPipe_IsNamed) {
  std::filesystem::remove(file("Header"));
  ASSERT_EQ(::mkfifo(file("Header").c_str(), 0600), 0);
  const std::string message = refusal();
  EXPECT_TRUE(message.starts_with("Header: is a pipe")) << message;
}

TEST_F(AmrexSource, Interruption_EndsOpening) {
  const std::atomic<bool> interrupted{true};
  SourceOptions options = named("density");
  options.cancel = &interrupted;
  EXPECT_EQ(message_of_error(ErrorKind::interrupted, [&] { open_source(path_, options); }), "interrupted");
  EXPECT_EQ(message_of_error(ErrorKind::interrupted, [&] { format_of(path_).list(path_, options); }), "interrupted");
}

TEST_F(AmrexSource, UnwrittenPart_IsEmptyWhereAllIsThere) {
  EXPECT_EQ(unwritten_part(file("Header")), "");
  std::filesystem::resize_file(file("Level_1/Cell_D_00001"), 300);
  EXPECT_EQ(unwritten_part(file("Header")), file("Level_1/Cell_D_00001") +
                                                ": has 300 bytes, and the FAB at offset 0 ends at 2391; the file is "
                                                "cut, or not written to its end");
  std::filesystem::remove(file("Level_1/Cell_D_00001"));
  EXPECT_EQ(unwritten_part(file("Header")), file("Level_1/Cell_D_00001") +
                                                ": cannot open for reading: No such file or directory; " +
                                                file("Level_1/Cell_H") + " has FABs in it");
}

TEST_F(AmrexSource, UnwrittenPart_IsEmptyWhereNothingMakesItReadable) {
  replace("Header", "Temp\n3\n", "Temp\n2\n");
  EXPECT_EQ(unwritten_part(file("Header")), "");
  replace("Header", "Temp\n2\n", "Temp\n3\n");
  replace("Header", "\n0\n0\n0 2", "\n1\n0\n0 2");
  EXPECT_EQ(unwritten_part(file("Header")), "");
  replace("Header", "\n1\n0\n0 2", "\n0\n0\n0 2");
  write_file(file("Level_1/Cell_H"), "1\n1\n2\n1\n");
  EXPECT_EQ(unwritten_part(file("Header")), "");
}

TEST_F(AmrexSource, TimeThatIsNotFinite_IsLeftOut) {
  replace("Header", "\n3\n1.5\n", "\n3\nnan\n");
  EXPECT_FALSE(open_amrex(path_, named("density"))->info().details.time.has_value());
}

TEST(AmrexSourceMemory, BoxesThatDoNotFit_NameAMemoryThatDoes) {
  const Scratch scratch;
  PlotfilePlan plan;
  plan.domain = {{0, 0, 0}, {32, 32, 32}};
  plan.boxes = {{}};
  for_each_index({{0, 0, 0}, {16, 16, 16}}, [&](const Index3& i) {
    plan.boxes[0].push_back({i * 2, i * 2 + Index3{2, 2, 2}});
  });
  plan.fabs_per_file = 4096;
  const std::string path = scratch.path("plt");
  test::write_plotfile(path, plan);
  SourceOptions options;
  options.memory = 1U << 20U;
  EXPECT_EQ(
      message_of_error(ErrorKind::usage, [&] { open_source(path, options); }),
      path + "/Level_0/Cell_H: its 4096 boxes take 352.0 KiB, more than a quarter of --memory; give at least 2MiB");
  options.memory = 2U << 20U;
  EXPECT_EQ(open_source(path, options)->info().extent, (Index3{32, 32, 32}));
}

}  // namespace
}  // namespace weir::amrex_source_test
