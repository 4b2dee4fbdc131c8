// Tests volumes of a header and raw values: sizes, offsets, --index, packed values and attributes.
#include "ingest/headers/header_volume.h"

#include <filesystem>

#include "format/base/text.h"
#include "tests/ingest/support/header_file.h"
#include "tests/ingest/support/packed.h"

namespace weir::header_volume_test {
namespace {

std::vector<std::uint16_t> ramp(std::size_t count) {
  std::vector<std::uint16_t> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<std::uint16_t>(i);
  return values;
}

/// The volume is an array of 2 x 1 x 2 x 3 x 2 big-endian uint16 values after a header of six bytes.
class HeaderVolumeTest : public ::testing::Test {
 protected:
  HeaderVolumeTest() {
    volume_.extents = {2, 1, 2, 3, 2};
    volume_.type = ScalarType::uint16;
    volume_.big_endian = true;
    volume_.data_offset = 6;
    use(write_headed(scratch_, "array.hv", "header", stored(ramp(24), true)));
  }
  void use(const std::string& path) {
    volume_.info.path = path;
    volume_.data_path = path;
    volume_.info.file_bytes = std::filesystem::file_size(path);
  }
  std::vector<float> values(const SourceOptions& options = {}) const {
    return read_volume(*open_header_volume(volume_, options));
  }
  std::string refusal(ErrorKind kind, const SourceOptions& options = {}) const {
    return message_of_error(kind, [&] { open_header_volume(volume_, options); });
  }

  Scratch scratch_;
  HeaderVolume volume_;
};

TEST_F(HeaderVolumeTest, IndexChoosesAlongTheSlowestAxesFirst) {
  SourceOptions options;
  options.index = {1, 2};
  EXPECT_EQ(values(options), (std::vector<float>{20, 21, 22, 23}));
  options.index = {0, 1};
  const auto source = open_header_volume(volume_, options);
  EXPECT_EQ(read_volume(*source), (std::vector<float>{4, 5, 6, 7}));
  EXPECT_EQ(source->info().extent, (Index3{2, 1, 2}));
  EXPECT_EQ(source->info().index, (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(source->info().file_bytes, 54);
}

TEST_F(HeaderVolumeTest, IndexMustFitTheAxes) {
  const std::string& path = volume_.info.path;
  EXPECT_EQ(refusal(ErrorKind::usage),
            path + ": axes after the third have the extents 2x3 (slowest first); give --index with 2 positions");
  SourceOptions options;
  options.index = {0, 3};
  EXPECT_EQ(refusal(ErrorKind::usage, options),
            path + ": --index 3 is outside its axis, which has the positions 0 to 2");
  options.index = {-1, 0};
  EXPECT_EQ(refusal(ErrorKind::usage, options),
            path + ": --index -1 is outside its axis, which has the positions 0 to 1");
  volume_.extents = {4, 3, 2};
  EXPECT_EQ(refusal(ErrorKind::usage, options),
            path + ": --index chooses along the axes after the third, and there is none; leave it out");
  options.index.clear();
  options.dataset = "a";
  EXPECT_EQ(refusal(ErrorKind::usage, options), path + ": holds one array without a name; leave --dataset out");
}

TEST_F(HeaderVolumeTest, SingletonAxesNeedNoIndexAndMissingAxesAreOne) {
  volume_.extents = {4, 3, 2, 1, 1};
  EXPECT_EQ(values(), as_floats(ramp(24)));
  volume_.extents = {24};
  const auto source = open_header_volume(volume_, {});
  EXPECT_EQ(source->info().extent, (Index3{24, 1, 1}));
  EXPECT_TRUE(source->info().index.empty());
}

TEST_F(HeaderVolumeTest, TheFileMustBeAsLongAsItsHeaderSays) {
  volume_.extents = {4, 3, 3};
  EXPECT_EQ(refusal(ErrorKind::input), volume_.info.path +
                                           ": has 48 bytes from offset 6 on, and its header asks for "
                                           "4x3x3 uint16, 72 bytes; the file is cut or the header wrong");
  volume_.extents = {4, 3, 1};
  EXPECT_EQ(refusal(ErrorKind::input), volume_.info.path +
                                           ": has 48 bytes from offset 6 on, and its header asks for "
                                           "4x3x1 uint16, 24 bytes; the header is wrong");
  volume_.at_end = true;
  EXPECT_EQ(values(), as_floats(std::vector<int>{12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}));
  volume_.extents = {4, 3, 2};
  volume_.data_offset = std::uint64_t{1} << 63U;
  EXPECT_EQ(refusal(ErrorKind::input),
            volume_.info.path +
                ": has 0 bytes from offset 9223372036854775808 on, and its header asks for 4x3x2 "
                "uint16, 48 bytes; the file is cut or the header wrong");
}

TEST_F(HeaderVolumeTest, BytesBehindTheValues_AreSaid_AndRefusedFromAPlaneOn) {
  volume_.extents = {4, 3, 2};
  volume_.offset_key = "vox_offset";
  const auto longer = [&](std::size_t more) {
    auto bytes = stored(ramp(24), true);
    bytes.resize(bytes.size() + more, std::byte{'\n'});
    use(write_headed(scratch_, "array.hv", "header", bytes));
  };
  for (const std::size_t more : {1U, 23U}) {
    longer(more);
    const std::string note = cat("the file has ", 54 + more,
                                 " bytes, and 48 of them, from byte 6 on, are what the header describes; where the "
                                 "values begin elsewhere, correct vox_offset");
    const auto source = open_header_volume(volume_, {});
    EXPECT_EQ(read_volume(*source), as_floats(ramp(24)));
    EXPECT_EQ(source->info().details.data_note, note);
    EXPECT_EQ(list_header_volume(volume_)[0].attributes.back(), (std::pair<std::string, std::string>{"note", note}));
  }
  longer(0);
  EXPECT_EQ(open_header_volume(volume_, {})->info().details.data_note, "");
  longer(24);
  const std::string message = volume_.info.path +
                              ": has 72 bytes from offset 6 on, and its header asks for 4x3x2 uint16, 48 bytes; the "
                              "header is wrong";
  EXPECT_EQ(refusal(ErrorKind::input), message);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { list_header_volume(volume_); }), message);
}

TEST_F(HeaderVolumeTest, MoreBytesBehindTheValuesThanFillABlock_AreRefused) {
  volume_.extents = {64, 64, 1};
  use(write_headed(scratch_, "array.hv", "header", std::vector<std::byte>(2 * 64 * 64 + 4096)));
  EXPECT_EQ(read_volume(*open_header_volume(volume_, {})).size(), std::size_t{64 * 64});
  use(write_headed(scratch_, "array.hv", "header", std::vector<std::byte>(2 * 64 * 64 + 4097)));
  EXPECT_EQ(refusal(ErrorKind::input), volume_.info.path +
                                           ": has 12289 bytes from offset 6 on, and its header asks for 64x64x1 "
                                           "uint16, 8192 bytes; the header is wrong");
}

// If nothing may follow the values, a longer file has something else before them, which would be read as the volume.
TEST_F(HeaderVolumeTest, BytesBehindTheValues_AreRefusedWhereNoneMayFollow) {
  volume_.extents = {4, 3, 2};
  volume_.ends_file = true;
  auto bytes = stored(ramp(24), true);
  bytes.resize(bytes.size() + 1);
  use(write_headed(scratch_, "array.hv", "header", bytes));
  EXPECT_EQ(refusal(ErrorKind::input), volume_.info.path +
                                           ": has 49 bytes from offset 6 on, and its header asks for 4x3x2 uint16, 48 "
                                           "bytes; something else comes before the values, and the header is wrong");
}

// The file holds two volumes of 24 bytes each. 23 more bytes after them are accepted, 24 are refused.
TEST_F(HeaderVolumeTest, BytesBehindSeveralValues_AreRefusedFromOneVolumeOn) {
  volume_.extents = {4, 3, 1, 2};
  SourceOptions second;
  second.index = {1};
  auto bytes = stored(ramp(24), true);
  bytes.resize(48 + 23);
  use(write_headed(scratch_, "array.hv", "header", bytes));
  EXPECT_EQ(values(second).back(), 23.0F);
  bytes.resize(48 + 24);
  use(write_headed(scratch_, "array.hv", "header", bytes));
  EXPECT_EQ(refusal(ErrorKind::input, second), volume_.info.path +
                                                   ": has 72 bytes from offset 6 on, and its header asks for 4x3x1x2 "
                                                   "uint16, 48 bytes; the header is wrong");
}

TEST_F(HeaderVolumeTest, SeveralHeadersMayShareADataFile) {
  volume_.data_path = write_headed(scratch_, "array.raw", "", stored(ramp(24), true));
  volume_.data_offset = 8;
  volume_.extents = {2, 2, 1};
  volume_.offset_key = "HeaderSize";
  EXPECT_EQ(values(), (std::vector<float>{4, 5, 6, 7}));
  EXPECT_EQ(open_header_volume(volume_, {})->info().file_bytes, 54);
  const std::string note = "its data file " + volume_.data_path +
                           " has 48 bytes, and 8 of them, from byte 8 on, are what the header describes; where the "
                           "values begin elsewhere, correct HeaderSize";
  EXPECT_EQ(open_header_volume(volume_, {})->info().details.data_note, note);
  EXPECT_EQ(list_header_volume(volume_)[0].attributes.back(), (std::pair<std::string, std::string>{"note", note}));
  volume_.at_end = true;
  EXPECT_EQ(open_header_volume(volume_, {})->info().details.data_note, "") << "the header says that others are before";
  volume_.at_end = false;
  volume_.extents = {2, 2, 5};
  EXPECT_EQ(open_header_volume(volume_, {})->info().details.data_note, "");
}

TEST_F(HeaderVolumeTest, NamesHeaderAndDataFileWhereThatIsMissing) {
  volume_.extents = {4, 3, 2};
  volume_.data_path = scratch_.path("none.raw");
  EXPECT_EQ(refusal(ErrorKind::input), volume_.info.path + ": its data file " + volume_.data_path +
                                           ": cannot open for reading: No such file or directory");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { list_header_volume(volume_); }),
            volume_.info.path + ": its data file " + volume_.data_path +
                ": cannot open for reading: No such file or directory");
  volume_.data_path = "a\nb";
  EXPECT_EQ(refusal(ErrorKind::input), volume_.info.path + ": its data file 'a?b' has control characters in its name");
}

TEST_F(HeaderVolumeTest, ImpossibleExtentsAreErrors) {
  const std::string& path = volume_.info.path;
  const std::int64_t much = std::int64_t{1} << 40U;
  volume_.extents = {much, much, much};
  EXPECT_EQ(refusal(ErrorKind::input), path +
                                           ": extent 1099511627776x1099511627776x1099511627776 has 1099511627776 "
                                           "voxels along x; each axis must be 1 to 2147483647");
  volume_.extents = {4, 0, 2};
  EXPECT_EQ(refusal(ErrorKind::input), path + ": extent 4x0x2 has 0 voxels along y; each axis must be 1 to 2147483647");
  volume_.extents = {4, 3, 2, -1};
  EXPECT_EQ(refusal(ErrorKind::input), path +
                                           ": extents 4x3x2x-1 of uint16 are impossible: each must be at least 1 "
                                           "and all bytes fit 63 bits");
  volume_.extents = {4, 3, 2, much, much};
  EXPECT_EQ(refusal(ErrorKind::input), path +
                                           ": extents 4x3x2x1099511627776x1099511627776 of uint16 are impossible: "
                                           "each must be at least 1 and all bytes fit 63 bits");
}

TEST_F(HeaderVolumeTest, UnpacksOneOfSeveralVolumes) {
  auto unpacked = stored(std::vector<std::uint16_t>{99});
  const auto values_bytes = stored(ramp(24), true);
  unpacked.insert(unpacked.end(), values_bytes.begin(), values_bytes.end());
  for (const Wrapper wrapper : {Wrapper::gzip, Wrapper::zlib}) {
    use(write_headed(scratch_, "array.hvz", "header", deflated(unpacked, wrapper)));
    volume_.packed = true;
    volume_.packed_offset = 2;
    SourceOptions options;
    options.index = {1, 0};
    const auto source = open_header_volume(volume_, options);
    EXPECT_EQ(read_volume(*source), (std::vector<float>{12, 13, 14, 15}));
    EXPECT_EQ(source->info().path, volume_.info.path);
    EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(volume_.info.path));
  }
}

TEST_F(HeaderVolumeTest, FileShorterThanItsPackedBytesIsRefused) {
  const auto packed = deflated(stored(ramp(24), true), Wrapper::zlib);
  use(write_headed(scratch_, "array.hvz", "header", packed));
  volume_.extents = {4, 3, 2};
  volume_.packed = true;
  volume_.packed_bytes = packed.size();
  EXPECT_EQ(values(), as_floats(ramp(24)));
  volume_.packed_bytes = packed.size() + 1;
  const std::string size = std::to_string(packed.size());
  EXPECT_EQ(refusal(ErrorKind::input), volume_.info.path + ": has " + size + " bytes from offset 6 on, and " +
                                           std::to_string(packed.size() + 1) +
                                           " compressed ones belong there; the file is cut");
  volume_.packed_bytes = 0;
  volume_.packed_offset = ~std::uint64_t{0};
  EXPECT_EQ(refusal(ErrorKind::input), volume_.info.path +
                                           ": values at byte 18446744073709551615 of the unpacked "
                                           "data are impossible; the header is damaged");
}

TEST_F(HeaderVolumeTest, MapsValuesAndAddsTheMissingValueOption) {
  volume_.extents = {4, 3, 2};
  volume_.info.mapping = {.scale = 0.5, .offset = -1, .missing = {std::int64_t{2}}};
  SourceOptions options;
  options.missing = std::int64_t{3};
  const auto read = values(options);
  EXPECT_EQ(read[0], -1.0F);
  EXPECT_EQ(read[1], -0.5F);
  EXPECT_TRUE(is_missing(read[2]));
  EXPECT_TRUE(is_missing(read[3]));
  EXPECT_EQ(read[23], 10.5F);
}

TEST_F(HeaderVolumeTest, ListsTypeExtentsAndAttributes) {
  volume_.info.units = "HU";
  volume_.info.mapping.scale = 2;
  volume_.info.spacing = {0.5, 1, 2};
  volume_.attributes = {{"orientation", "oblique"}};
  const DatasetInfo listed = list_header_volume(volume_).at(0);
  EXPECT_EQ(listed.name, "");
  EXPECT_EQ(listed.extents, (std::vector<std::int64_t>{2, 1, 2, 3, 2}));
  EXPECT_EQ(listed.type, "big-endian uint16");
  EXPECT_EQ(listed.layout, "contiguous");
  EXPECT_EQ(listed.leading_axes, 2);
  const std::vector<std::pair<std::string, std::string>> attributes{{"spacing", "0.5,1,2"}, {"origin", "0,0,0"},
                                                                    {"units", "HU"},        {"scale", "2"},
                                                                    {"offset", "0"},        {"orientation", "oblique"}};
  EXPECT_EQ(listed.attributes, attributes);
}

}  // namespace
}  // namespace weir::header_volume_test
