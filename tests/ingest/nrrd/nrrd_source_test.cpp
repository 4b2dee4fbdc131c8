#include "ingest/nrrd/nrrd_source.h"

#include <filesystem>

#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/nrrd/nrrd_header.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/header_file.h"
#include "tests/ingest/support/packed.h"

namespace weir::nrrd_source_test {
namespace {

std::vector<std::uint8_t> ramp() {
  std::vector<std::uint8_t> values(24);
  for (std::size_t i = 0; i < 24; ++i) values[i] = static_cast<std::uint8_t>(i);
  return values;
}

/// Returns a header of 4 x 3 x 2 uint8 values with more fields, including the blank line.
std::string header(const std::string& fields = "", const std::string& encoding = "raw") {
  return "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: " + encoding + "\n" + fields + "\n";
}

std::string refusal(const std::string& path) {
  return message_of_error(ErrorKind::input, [&] { open_source(path, {}); });
}

template <typename T>
void expect_type(const std::string& name) {
  const Scratch scratch;
  const auto values = telling_values<T>(24);
  for (const bool big : {false, true}) {
    for (const bool gzip : {false, true}) {
      const std::string text = "NRRD0004\ntype: " + name +
                               "\ndimension: 3\nsizes: 4 3 2\nencoding: " + (gzip ? "gzip" : "raw") +
                               "\nendian: " + (big ? "big" : "little") + "\n\n";
      const auto bytes = stored(values, big);
      const std::string path = write_headed(scratch, "a.nrrd", text, gzip ? deflated(bytes, Wrapper::gzip) : bytes);
      const auto source = open_source(path, {});
      EXPECT_EQ(source->info().format, "nrrd");
      EXPECT_EQ(source->info().extent, (Index3{4, 3, 2}));
      EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(path));
      EXPECT_EQ(read_volume(*source), as_floats(values)) << name << big << gzip;
    }
  }
}

TEST(NrrdSource, ReadsEveryTypeInBothByteOrdersPlainAndPacked) {
  expect_type<std::int8_t>("signed char");
  expect_type<std::uint8_t>("uchar");
  expect_type<std::int16_t>("short");
  expect_type<std::uint16_t>("unsigned short");
  expect_type<std::int32_t>("int");
  expect_type<std::uint32_t>("uint32");
  expect_type<std::int64_t>("long long int");
  expect_type<std::uint64_t>("uint64_t");
  expect_type<float>("float");
  expect_type<double>("double");
}

TEST(NrrdSource, TakesPlaceLabelsAndUnits) {
  const Scratch scratch;
  const std::string path = write_headed(scratch, "a.nrrd",
                                        header("space: right-anterior-superior\nspace origin: (-10,20,5)\n"
                                               "space directions: (0.5,0,0) (0,0.25,0) (0,0,2)\n"
                                               "labels: \"x\" \"y\" \"height\"\nsample units: K\n"),
                                        stored(ramp()));
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{-10, 20, 5}));
  EXPECT_EQ(source->info().axis_labels, (std::array<std::string, 3>{"x", "y", "height"}));
  EXPECT_EQ(source->info().units, "K");
}

TEST(NrrdSource, SpacingsAndAxisRangesGiveThePlacement) {
  const Scratch scratch;
  const auto info = [&](const std::string& fields) {
    return open_source(write_headed(scratch, "a.nrrd", header(fields), stored(ramp())), {})->info();
  };
  EXPECT_EQ(info("spacings: 0.5 nan -2\n").spacing, (std::array<double, 3>{0.5, 1, 2}));
  // Values are cell-centred by default: 4 values from 0 to 8 are 2 apart, and the first lies in the middle of its cell.
  const SourceInfo ranges = info("axis mins: 0 nan 10\naxis maxs: 8 nan 13\ncenters: cell ??? node\n");
  EXPECT_EQ(ranges.spacing, (std::array<double, 3>{2, 1, 3}));
  EXPECT_EQ(ranges.origin, (std::array<double, 3>{1, 0, 10}));
}

// The ranges 20 to 0 and the space direction -1 describe the same axis.
TEST(NrrdSource, FallingAxisMins_PlaceTheVoxels) {
  const Scratch scratch;
  const auto open = [&](const std::string& fields) {
    return open_source(write_headed(scratch, "a.nrrd", header(fields), stored(ramp())), {});
  };
  const std::string falls = "axes along -x, +y, +z of the file's world; voxels keep the file's order";
  const auto cells = open("axis mins: 20 0 0\naxis maxs: 0 12 8\n");
  EXPECT_EQ(cells->info().spacing, (std::array<double, 3>{5, 4, 4}));
  EXPECT_EQ(cells->info().origin, (std::array<double, 3>{17.5, 2, 2})) << "the first sample lies within the range";
  EXPECT_EQ(cells->info().details.orientation, falls);
  EXPECT_EQ(read_volume(*cells), as_floats(ramp()));
  EXPECT_EQ(list_nrrd(cells->info().path, {}).at(0).attributes.back(),
            (std::pair<std::string, std::string>{"orientation", falls}));
  const auto directions =
      open("space dimension: 3\nspace directions: (-5,0,0) (0,4,0) (0,0,4)\nspace origin: (17.5,2,2)\n");
  EXPECT_EQ(directions->info().spacing, cells->info().spacing);
  EXPECT_EQ(directions->info().origin, cells->info().origin);
  EXPECT_EQ(directions->info().details.orientation, falls);

  const SourceInfo nodes = open("axis mins: 20 0 0\naxis maxs: 5 8 1\ncenterings: node node node\n")->info();
  EXPECT_EQ(nodes.spacing, (std::array<double, 3>{5, 4, 1}));
  EXPECT_EQ(nodes.origin, (std::array<double, 3>{20, 0, 0}));
  EXPECT_EQ(nodes.details.orientation, falls);
  const SourceInfo rising = open("axis mins: 0 0 0\naxis maxs: 20 12 8\n")->info();
  EXPECT_EQ(rising.origin, (std::array<double, 3>{2.5, 2, 2}));
  EXPECT_EQ(rising.details.orientation, "");
}

TEST(NrrdSource, FallingAxesWithSpacings_AreSaid) {
  const Scratch scratch;
  const auto info = [&](const std::string& fields) {
    return open_source(write_headed(scratch, "a.nrrd", header(fields), stored(ramp())), {})->info();
  };
  // The range gives the direction, and the spacing gives the distance.
  const SourceInfo both = info("spacings: 5 nan 4\naxis mins: 20 12 0\naxis maxs: 0 0 8\n");
  EXPECT_EQ(both.spacing, (std::array<double, 3>{5, 4, 4}));
  EXPECT_EQ(both.origin, (std::array<double, 3>{17.5, 10, 2}));
  EXPECT_EQ(both.details.orientation, "axes along -x, -y, +z of the file's world; voxels keep the file's order");
  const SourceInfo spacings = info("spacings: 1 1 -2\n");
  EXPECT_EQ(spacings.spacing, (std::array<double, 3>{1, 1, 2}));
  EXPECT_EQ(spacings.details.orientation, "axes along +x, +y, -z of the file's world; voxels keep the file's order");
}

TEST(NrrdSource, UnitsOfAxes_AreKept_AndSaidWhereTheyDiffer) {
  const Scratch scratch;
  const auto info = [&](const std::string& fields) {
    return open_source(write_headed(scratch, "a.nrrd", header(fields), stored(ramp())), {})->info();
  };
  const auto units = [](const SourceInfo& of) {
    return std::array<std::string, 3>{of.details.axes[0].units, of.details.axes[1].units, of.details.axes[2].units};
  };
  const SourceInfo same = info("units: \"mm\" \"mm\" \"mm\"\nspacings: 1 1 2\n");
  EXPECT_EQ(units(same), (std::array<std::string, 3>{"mm", "mm", "mm"}));
  EXPECT_EQ(same.details.units_note, "");
  const SourceInfo mixed = info("units: \"mm\" \"mm\" \"um\"\nlabels: \"\" \"\" \"depth\"\n");
  EXPECT_EQ(units(mixed), (std::array<std::string, 3>{"mm", "mm", "um"}));
  EXPECT_EQ(mixed.details.units_note, "axis x is in mm, y in mm, z (depth) in um");
  // Each array axis has the unit of the world axis that it runs along. Here the array's x runs along the world's z.
  const std::string space = "space dimension: 3\nspace units: \"mm\" \"mm\" \"um\"\n";
  const SourceInfo turned = info(space + "space directions: (0,0,2) (0,-1,0) (1,0,0)\n");
  EXPECT_EQ(units(turned), (std::array<std::string, 3>{"um", "mm", "mm"}));
  EXPECT_EQ(turned.details.units_note, "axis x is in um, y in mm, z in mm");
  const SourceInfo oblique = info(space + "space directions: (1,1,0) (1,-1,0) (0,1,1)\n");
  EXPECT_EQ(units(oblique), (std::array<std::string, 3>{"mm", "mm", ""}));
  const auto listed = list_nrrd(scratch.path("a.nrrd"), {}).at(0).attributes;
  EXPECT_EQ(listed.at(2), (std::pair<std::string, std::string>{"axis units", "mm,mm,"}));
}

TEST(NrrdSource, AxisWithoutADirection_IsPlacedByItsSpacing) {
  const Scratch scratch;
  const std::string fields =
      "kinds: domain domain domain\nspace dimension: 3\nspace directions: (2,0,0) (0,2,0) none\nspacings: nan nan 3\n";
  const auto source = open_source(write_headed(scratch, "a.nrrd", header(fields), stored(ramp())), {});
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{2, 2, 3}));
}

TEST(NrrdSource, KeepsTheOrderOfFlippedAxesAndSaysSo) {
  const Scratch scratch;
  const std::string path =
      write_headed(scratch, "a.nrrd",
                   header("space dimension: 3\nspace directions: (-1,0,0) (0,-2,0) (0,0,3)\nspace origin: (7,8,9)\n"),
                   stored(ramp()));
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{7, 8, 9}));
  EXPECT_EQ(read_volume(*source), as_floats(ramp()));
  const std::string orientation = "axes along -x, -y, +z of the file's world; voxels keep the file's order";
  EXPECT_EQ(source->info().details.orientation, orientation);
  const auto attributes = list_nrrd(path, {}).at(0).attributes;
  EXPECT_EQ(attributes.back(), (std::pair<std::string, std::string>{"orientation", orientation}));
}

TEST(NrrdSource, FourthAxisOfOneValueIsDropped) {
  const Scratch scratch;
  const std::string sizes = "NRRD0004\ntype: uint8\nencoding: raw\n";
  for (const std::string rest :
       {"dimension: 4\nsizes: 1 4 3 2\n\n", "dimension: 4\nsizes: 1 4 3 2\nkinds: scalar domain domain domain\n\n",
        "dimension: 4\nsizes: 4 3 2 1\n\n", "dimension: 4\nsizes: 4 3 2 1\nkinds: space space space time\n\n",
        "dimension: 4\nsizes: 1 4 3 2\nspace dimension: 3\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n\n"}) {
    const auto source = open_source(write_headed(scratch, "a.nrrd", sizes + rest, stored(ramp())), {});
    EXPECT_EQ(source->info().extent, (Index3{4, 3, 2})) << rest;
  }
  const auto thin =
      open_source(write_headed(scratch, "a.nrrd",
                               sizes + "dimension: 3\nsizes: 1 12 2\nkinds: domain domain domain\n\n", stored(ramp())),
                  {});
  EXPECT_EQ(thin->info().extent, (Index3{1, 12, 2}));
}

TEST(NrrdSource, IndexChoosesATimeStep) {
  const Scratch scratch;
  const std::string path = write_headed(
      scratch, "a.nrrd", "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 4\nsizes: 4 3 1 2\n\n", stored(ramp()));
  SourceOptions options;
  options.index = {1};
  EXPECT_EQ(read_volume(*open_source(path, options)),
            (std::vector<float>{12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}));
  EXPECT_EQ(list_nrrd(path, {}).at(0).leading_axes, 1);
}

TEST(NrrdSource, RefusesVectorsAndColours) {
  const Scratch scratch;
  const std::string sizes = "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 4\nsizes: 3 4 2 1\n";
  std::string path =
      write_headed(scratch, "a.nrrd", sizes + "kinds: RGB-color domain domain domain\n\n", stored(ramp()));
  EXPECT_EQ(refusal(path), path +
                               ": axis 0 of 3 values and kind 'rgb-color' is no axis of space; take one component "
                               "with `unu slice -a 0 -p 0`");
  path = write_headed(scratch, "a.nrrd", sizes + "space directions: none (1,0,0) (0,1,0) (0,0,1)\n\n", stored(ramp()));
  EXPECT_EQ(refusal(path),
            path + ": axis 0 of 3 values is no axis of space; take one component with `unu slice -a 0 -p 0`");
}

TEST(NrrdSource, TimeAmongTheFirstThreeAxes_IsRefused) {
  const Scratch scratch;
  const auto refused = [&](const std::string& fields) {
    const std::string path =
        write_headed(scratch, "a.nrrd", "NRRD0004\ntype: uint8\nencoding: raw\n" + fields + "\n\n", stored(ramp()));
    return refusal(path).substr(path.size());
  };
  EXPECT_EQ(refused("dimension: 4\nsizes: 2 4 3 1\nkinds: time domain domain domain"),
            ": axis 0 of 2 values and kind 'time' is no axis of space; take one time step with `unu slice -a 0 -p 0`, "
            "or make it the last axis with `unu permute -p 1 2 3 0`");
  EXPECT_EQ(refused("dimension: 4\nsizes: 4 3 2 1\nkinds: space space time space"),
            ": axis 2 of 2 values and kind 'time' is no axis of space; take one time step with `unu slice -a 2 -p 0`, "
            "or make it the last axis with `unu permute -p 0 1 3 2`");
  // A space direction does not make a time axis an axis of space.
  EXPECT_EQ(refused("dimension: 4\nsizes: 2 4 3 1\nkinds: time space space space\nspace dimension: 3\n"
                    "space directions: (1,0,0) (1,0,0) (0,1,0) (0,0,1)"),
            ": axis 0 of 2 values and kind 'time' is no axis of space; take one time step with `unu slice -a 0 -p 0`, "
            "or make it the last axis with `unu permute -p 1 2 3 0`");
  EXPECT_EQ(refused("dimension: 5\nsizes: 1 4 2 3 1\nkinds: scalar space time space space"),
            ": axis 2 of 2 values and kind 'time' is no axis of space; take one time step with `unu slice -a 2 -p 0`, "
            "or make it the last axis with `unu permute -p 0 1 3 4 2`");
  // Of only three axes, a time axis that is moved to the end would be taken for z. So the message offers no
  // permutation.
  EXPECT_EQ(refused("dimension: 3\nsizes: 4 3 2\nkinds: space space time"),
            ": axis 2 of 2 values and kind 'time' is no axis of space; take one time step with `unu slice -a 2 -p 0`");
}

TEST(NrrdSource, TimeAxisOfOneStepInFront_IsDropped) {
  const Scratch scratch;
  const std::string path = write_headed(
      scratch, "a.nrrd",
      "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 4\nsizes: 1 4 3 2\nkinds: time space space space\n\n",
      stored(ramp()));
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().extent, (Index3{4, 3, 2}));
  EXPECT_EQ(read_volume(*source), as_floats(ramp()));
}

TEST(NrrdSource, TimeAfterTheThirdAxis_IsChosenByIndex) {
  const Scratch scratch;
  const std::string path = write_headed(
      scratch, "a.nrrd",
      "NRRD0004\ntype: uint8\nencoding: raw\ndimension: 4\nsizes: 4 3 1 2\nkinds: space space space time\n\n",
      stored(ramp()));
  SourceOptions options;
  options.index = {1};
  EXPECT_EQ(read_volume(*open_source(path, options)),
            (std::vector<float>{12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}));
}

TEST(NrrdSource, ReadsDetachedValues) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch.path("data"));
  auto values = stored(ramp());
  write_headed(scratch, "data/a.raw", "two\nlines\nfour", values);
  const std::string skips = header("line skip: 2\nbyte skip: 4\ndata file: data/a.raw\n");
  std::string path = write_headed(scratch, "a.nhdr", skips);
  const auto source = open_source(path, {});
  EXPECT_EQ(read_volume(*source), as_floats(ramp()));
  EXPECT_EQ(source->info().path, path);
  EXPECT_EQ(source->info().file_bytes, skips.size());

  path = write_headed(scratch, "b.nhdr", header("byte skip: -1\ndata file: " + scratch.path("data/a.raw") + "\n"));
  EXPECT_EQ(read_volume(*open_source(path, {})), as_floats(ramp()));

  // Bytes are skipped in the unpacked data. Lines are skipped in the file, before the compressed data.
  values.insert(values.begin(), 5, std::byte{0xEE});
  write_headed(scratch, "data/a.raw.gz", "line\n", deflated(values, Wrapper::gzip));
  path = write_headed(scratch, "c.nhdr", header("line skip: 1\nbyte skip: 5\ndata file: data/a.raw.gz\n", "gzip"));
  EXPECT_EQ(read_volume(*open_source(path, {})), as_floats(ramp()));
  EXPECT_EQ(list_nrrd(path, {}).at(0).layout, "one compressed stream");

  path = write_headed(scratch, "d.nhdr", header("line skip: 9\ndata file: data/a.raw\n"));
  EXPECT_TRUE(refusal(path).ends_with(" lines before its values begin; check line skip")) << refusal(path);
  path = write_headed(scratch, "e.nhdr", header("line skip: 9\ndata file: none.raw\n"));
  EXPECT_EQ(refusal(path), path + ": its data file " + scratch.path("none.raw") +
                               ": cannot open for reading: No such file or directory");
}

TEST(NrrdSource, AFileCutAtAnyByteIsRefused) {
  const Scratch scratch;
  for (const std::string encoding : {"raw", "gzip"}) {
    const std::string text = header("", encoding);
    auto bytes = stored(ramp());
    if (encoding == "gzip") bytes = deflated(bytes, Wrapper::gzip);
    const std::string whole = text + std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t size = kNrrdMagic.size(); size < whole.size(); ++size) {
      EXPECT_FALSE(refusal(write_headed(scratch, "cut.nrrd", whole.substr(0, size))).empty()) << size;
    }
    // A plain file may have extra bytes behind its values, but not as many as a second volume.
    const std::size_t more = encoding == "raw" ? 24 : 1;
    EXPECT_FALSE(refusal(write_headed(scratch, "long.nrrd", whole + std::string(more, 'x'))).empty());
  }
}

TEST(NrrdSource, LineEndBehindTheValues_IsSaid) {
  const Scratch scratch;
  auto values = stored(ramp());
  values.push_back(std::byte{'\n'});
  const std::size_t begin = header().size();
  const auto source = open_source(write_headed(scratch, "a.nrrd", header(), values), {});
  EXPECT_EQ(read_volume(*source), as_floats(ramp()));
  EXPECT_EQ(source->info().details.data_note,
            cat("the file has ", begin + 25, " bytes, and 24 of them, from byte ", begin,
                " on, are what the header describes; where the values begin elsewhere, correct byte skip"));
}

TEST(NrrdSource, OversizedHeadersAndBombsAreRefused) {
  const Scratch scratch;
  std::string path = write_headed(scratch, "wide.nrrd",
                                  "NRRD0004\ntype: uint8\nencoding: gzip\ndimension: 3\n"
                                  "sizes: 1000000000 1000000000 2\n\n",
                                  deflated(stored(ramp()), Wrapper::gzip));
  EXPECT_TRUE(
      refusal(path).ends_with("compressed bytes cannot hold the 2000000000000000000 bytes its header asks "
                              "for; one of the two is damaged"))
      << refusal(path);
  path = write_headed(scratch, "bomb.nrrd", header("", "gzip"),
                      deflated(std::vector<std::byte>(std::size_t{32} << 20U), Wrapper::gzip));
  EXPECT_EQ(refusal(path), path + ": unpacks to more than the 24 bytes its header asks for; one of the two is damaged");
  path = write_headed(scratch, "line.nrrd", "NRRD0004\n# " + std::string(3 * kHeaderLimit, 'x'));
  EXPECT_EQ(refusal(path), path + ": its header does not end within 1048576 bytes");
}

}  // namespace
}  // namespace weir::nrrd_source_test
