#include "ingest/nifti/nifti_source.h"

#include <filesystem>
#include <fstream>
#include <limits>

#include "ingest/source_registry.h"
#include "tests/ingest/support/header_file.h"
#include "tests/ingest/support/nifti_file.h"
#include "tests/ingest/support/packed.h"
#include "tests/support/python.h"

namespace weir::nifti_source_test {
namespace {

std::vector<std::uint8_t> ramp() {
  std::vector<std::uint8_t> values(24);
  for (std::size_t i = 0; i < 24; ++i) values[i] = static_cast<std::uint8_t>(i);
  return values;
}

std::vector<std::byte> whole_file(const NiftiBytes& header, std::span<const std::byte> values) {
  const auto head = std::as_bytes(std::span(header.bytes()));
  std::vector<std::byte> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), values.begin(), values.end());
  return bytes;
}

std::string refusal(const std::string& path, ErrorKind kind = ErrorKind::input) {
  return message_of_error(kind, [&] { open_source(path, {}); });
}

template <typename T>
void expect_type(std::int16_t code) {
  const Scratch scratch;
  const auto values = telling_values<T>(24);
  for (const int version : {1, 2}) {
    for (const bool big : {false, true}) {
      NiftiBytes header(version, big);
      const auto bytes = whole_file(header.set(version == 1 ? 70 : 12, code), stored(values, big));
      for (const std::string name : {"a.nii", "a.nii.gz"}) {
        const std::string path = scratch.write(name, name == "a.nii" ? bytes : deflated(bytes, Wrapper::gzip));
        const auto source = open_source(path, {});
        EXPECT_EQ(source->info().format, "nifti");
        EXPECT_EQ(source->info().extent, (Index3{4, 3, 2}));
        EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(path));
        EXPECT_EQ(read_volume(*source), as_floats(values)) << code << name << version << big;
      }
    }
  }
}

TEST(NiftiSource, ReadsEveryTypeInBothByteOrdersPlainAndPacked) {
  expect_type<std::uint8_t>(2);
  expect_type<std::int16_t>(4);
  expect_type<std::int32_t>(8);
  expect_type<float>(16);
  expect_type<double>(64);
  expect_type<std::int8_t>(256);
  expect_type<std::uint16_t>(512);
  expect_type<std::uint32_t>(768);
  expect_type<std::int64_t>(1024);
  expect_type<std::uint64_t>(1280);
}

TEST(NiftiSource, TakesPlaceAndScale) {
  const Scratch scratch;
  NiftiBytes header(1);
  header.set_all<float>(76, {1, 9, 9, 9}).set<float>(112, 0.5F).set<float>(116, -1).set<std::int16_t>(254, 1);
  header.set_all<float>(280, {-0.5F, 0, 0, 90, 0, 0.25F, 0, -126, 0, 0, 2, -72}).set_text(123, "\x02");
  const std::string path = scratch.write("a.nii", whole_file(header, stored(ramp())));
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{90, -126, -72}));
  EXPECT_EQ(read_volume(*source)[23], 10.5F);
  const std::vector<std::pair<std::string, std::string>> attributes{
      {"spacing", "0.5,0.25,2"},
      {"origin", "90,-126,-72"},
      {"scale", "0.5"},
      {"offset", "-1"},
      {"length unit", "mm"},
      {"orientation", "axes along -x, +y, +z of the file's world; voxels keep the file's order"}};
  EXPECT_EQ(list_nifti(path, {}).at(0).attributes, attributes);
}

TEST(NiftiSource, SformThatIsNoPlace_IsSaid) {
  const Scratch scratch;
  NiftiBytes header(1);
  header.set_all<float>(76, {1, 0.5F, 0.25F, 2}).set<std::int16_t>(252, 1).set<std::int16_t>(254, 1);
  header.set_all<float>(268, {7, 8, 9});
  const std::string path = scratch.write("a.nii", whole_file(header, stored(ramp())));
  const SourceInfo info = open_source(path, {})->info();
  EXPECT_EQ(info.spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{7, 8, 9}));
  const std::string note = "its sform has a column that is zero or not finite; the place is that of the qform";
  EXPECT_EQ(info.details.values_note, note);
  EXPECT_EQ(list_nifti(path, {}).at(0).attributes.back(), (std::pair<std::string, std::string>{"placement", note}));
}

TEST(NiftiSource, LengthUnit_IsOfAllAxes) {
  const Scratch scratch;
  for (const auto& [code, unit] : {std::pair('\0', ""), {'\1', "m"}, {'\2', "mm"}, {'\3', "um"}, {'\4', ""}}) {
    NiftiBytes header(1);
    const std::string path =
        scratch.write("a.nii", whole_file(header.set_text(123, std::string(1, code)), stored(ramp())));
    const SourceInfo info = open_source(path, {})->info();
    for (const AxisDetails& axis : info.details.axes) EXPECT_EQ(axis.units, unit);
    EXPECT_FALSE(info.details.time) << "it has no fourth axis";
  }
}

/// Returns a header of two volumes of 4 x 3 x 1 voxels, half a unit of time apart. The first one is at time 3.
NiftiBytes two_times(int version, bool big_endian, std::int32_t units) {
  NiftiBytes header(version, big_endian);
  if (version == 1) {
    header.set_all<std::int16_t>(40, {4, 4, 3, 1, 2}).set(123, static_cast<std::uint8_t>(units));
    return header.set<float>(92, 0.5F).set<float>(136, 3);
  }
  header.set_all<std::int64_t>(16, {4, 4, 3, 1, 2}).set(500, units);
  return header.set<double>(136, 0.5).set<double>(216, 3);
}

TEST(NiftiSource, TimeOfAVolume_IsThatOfItsPositionOnTheFourthAxis) {
  const Scratch scratch;
  SourceOptions second;
  second.index = {1};
  SourceOptions first;
  first.index = {0};
  for (const int version : {1, 2}) {
    for (const auto& [code, unit] : {std::pair(8, "s"), {16, "ms"}, {24, "us"}}) {
      const NiftiBytes header = two_times(version, version == 2, code + 2);
      const std::string path = scratch.write("a.nii", whole_file(header, stored(ramp())));
      const auto at = [&](const SourceOptions& options) { return open_source(path, options)->info().details.time; };
      ASSERT_TRUE(at(second)) << version << unit;
      EXPECT_EQ(at(second)->value, 3.5);
      EXPECT_EQ(at(second)->units, unit);
      EXPECT_EQ(at(first)->value, 3);
      EXPECT_EQ(open_source(path, second)->info().details.axes[2].units, "mm");
    }
    for (const int code : {0, 32, 40, 48}) {  // unit codes: none, Hz, ppm, rad/s
      const std::string path = scratch.write("a.nii", whole_file(two_times(version, false, code), stored(ramp())));
      EXPECT_FALSE(open_source(path, second)->info().details.time) << version << ' ' << code;
    }
  }
}

TEST(NiftiSource, TimeWithoutAStep_IsKnownOfTheFirstVolumeOnly) {
  const Scratch scratch;
  for (const float step : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
    NiftiBytes header = two_times(1, false, 8);
    const std::string path = scratch.write("a.nii", whole_file(header.set<float>(92, step), stored(ramp())));
    SourceOptions options;
    options.index = {1};
    EXPECT_FALSE(open_source(path, options)->info().details.time) << step;
    options.index = {0};
    EXPECT_EQ(open_source(path, options)->info().details.time->value, 3) << step;
  }
}

TEST(NiftiSource, ReadsPairsAndExtensions) {
  const Scratch scratch;
  NiftiBytes pair(1);
  pair.set_text(344, "ni1").set<float>(108, 16);
  std::string path = write_headed(scratch, "a.hdr", pair.bytes());
  EXPECT_EQ(refusal(path),
            path + ": its data file " + scratch.path("a.img") + ": cannot open for reading: No such file or directory");
  write_headed(scratch, "a.img", std::string(16, 'e'), stored(ramp()));
  EXPECT_EQ(read_volume(*open_source(path, {})), as_floats(ramp()));
  EXPECT_EQ(open_source(path, {})->info().file_bytes, 352);

  NiftiBytes extended(1);
  auto values = stored(ramp());
  values.insert(values.begin(), 48, std::byte{0xEE});
  const auto bytes = whole_file(extended.set<float>(108, 400), values);
  EXPECT_EQ(read_volume(*open_source(scratch.write("b.nii", bytes), {})), as_floats(ramp()));
  EXPECT_EQ(read_volume(*open_source(scratch.write("b.nii.gz", deflated(bytes, Wrapper::gzip)), {})),
            as_floats(ramp()));

  write_headed(scratch, "B.IMG", std::string(16, 'e'), stored(ramp()));
  EXPECT_EQ(open_source(write_headed(scratch, "B.HDR", pair.bytes()), {})->info().extent,
            open_source(scratch.path("a.hdr"), {})->info().extent);
  path = scratch.write("c.nii.gz", deflated(whole_file(pair, {}), Wrapper::gzip));
  EXPECT_EQ(refusal(path), path + ": is the packed header of a .hdr and .img pair; unpack both with gunzip");
}

TEST(NiftiSource, IndexChoosesATimeStep) {
  const Scratch scratch;
  NiftiBytes header(1);
  header.set_all<std::int16_t>(40, {5, 4, 3, 1, 1, 2});
  const auto bytes = whole_file(header, stored(ramp()));
  SourceOptions options;
  options.index = {1, 0};
  for (const std::string name : {"a.nii", "a.nii.gz"}) {
    const std::string path = scratch.write(name, name == "a.nii" ? bytes : deflated(bytes, Wrapper::gzip));
    EXPECT_EQ(read_volume(*open_source(path, options)),
              (std::vector<float>{12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}));
    EXPECT_EQ(refusal(path, ErrorKind::usage), path +
                                                   ": axes after the third have the extents 2x1 (slowest first); "
                                                   "give --index with 2 positions");
  }
}

TEST(NiftiSource, IsRecognisedByItsName) {
  const std::string header = NiftiBytes(2, true).bytes();
  const auto head = std::as_bytes(std::span(header)).first(kMagicBytes);
  EXPECT_TRUE(recognises_nifti("a.nii", {}));
  EXPECT_TRUE(recognises_nifti("A.NII.GZ", {}));
  EXPECT_TRUE(recognises_nifti("a.hdr", head));
  EXPECT_FALSE(recognises_nifti("a.hdr", {}));  // ENVI and other formats use the ending .hdr, too
  EXPECT_FALSE(recognises_nifti("a.gz", head));
  EXPECT_FALSE(recognises_nifti("a.raw", head));
}

TEST(NiftiSource, AFileCutAtAnyByteIsRefused) {
  const Scratch scratch;
  const auto plain = whole_file(NiftiBytes(1), stored(ramp()));
  for (const std::string name : {"a.nii", "a.nii.gz"}) {
    auto bytes = name == "a.nii" ? plain : deflated(plain, Wrapper::gzip);
    for (std::size_t size = 1; size < bytes.size(); ++size) {
      EXPECT_FALSE(refusal(scratch.write(name, std::span(bytes).first(size))).empty()) << size;
    }
    // A plain file may have extra bytes behind its values, but not as many as a second volume.
    bytes.resize(bytes.size() + (name == "a.nii" ? 24 : 1), std::byte{1});
    EXPECT_FALSE(refusal(scratch.write(name, bytes)).empty());
  }
}

TEST(NiftiSource, PaddingBehindTheValues_IsSaid) {
  const Scratch scratch;
  auto bytes = whole_file(NiftiBytes(1), stored(ramp()));
  bytes.resize(384);
  const auto source = open_source(scratch.write("a.nii", bytes), {});
  EXPECT_EQ(read_volume(*source), as_floats(ramp()));
  EXPECT_EQ(source->info().details.data_note,
            "the file has 384 bytes, and 24 of them, from byte 352 on, are what the header describes; where the values "
            "begin elsewhere, correct vox_offset");
}

TEST(NiftiSource, ExtensionsThatTheOffsetDoesNotPass_AreNotTakenForValues) {
  const Scratch scratch;
  auto bytes = whole_file(NiftiBytes(1), stored(ramp()));
  bytes[348] = std::byte{1};
  EXPECT_EQ(read_volume(*open_source(scratch.write("a.nii", bytes), {})),
            as_floats(ramp()));  // the flag is set, but the file has no extensions
  bytes.resize(384);
  const std::string path = scratch.write("b.nii", bytes);
  EXPECT_EQ(refusal(path), path +
                               ": has 32 bytes from offset 352 on, and its header asks for 4x3x2 uint8, 24 bytes; "
                               "something else comes before the values, and the header is wrong");
}

TEST(NiftiSource, GarbageAndBombsAreRefused) {
  const Scratch scratch;
  std::string path = scratch.write("text.nii", std::vector<std::byte>(400, std::byte{'x'}));
  EXPECT_EQ(refusal(path), path + ": is no NIfTI file: its first four bytes are neither 348 nor 540");
  auto bomb = whole_file(NiftiBytes(1), stored(ramp()));
  bomb.resize(std::size_t{32} << 20U);
  path = scratch.write("bomb.nii.gz", deflated(bomb, Wrapper::gzip));
  EXPECT_EQ(refusal(path),
            path + ": unpacks to more than the 376 bytes its header asks for; one of the two is damaged");
  // A gzip header whose file name never ends.
  std::vector<std::byte> endless(std::size_t{3} << 20U, std::byte{'n'});
  const auto start = stored(std::vector<std::uint8_t>{0x1F, 0x8B, 8, 8, 0, 0, 0, 0, 0, 3});
  std::copy(start.begin(), start.end(), endless.begin());
  path = scratch.write("endless.nii.gz", endless);
  EXPECT_EQ(refusal(path), path + ": is no NIfTI file: its first four bytes are neither 348 nor 540");
}

// Tests files that nibabel writes. The values that nibabel reads back go beside each file as float32, x fastest.
TEST(NiftiSource, ReadsWhatNibabelWrites) {
  if (!python_has("nibabel, numpy")) GTEST_SKIP() << "python3 with nibabel is missing";
  const Scratch scratch;
  const std::string script = R"(
import sys, numpy as np, nibabel as nib
rng = np.random.default_rng(1)
shape = (9, 7, 5)
affine = np.diag([0.5, 0.75, 2.0, 1.0]); affine[:3, 3] = [-10, 20.5, 3]
def save(name, values, kind, order="<", slope=None):
    header = kind.header_class(endianness=order)
    image = kind(values, affine, header=header)
    image.header.set_data_dtype(values.dtype)
    if slope: image.header.set_slope_inter(*slope)
    path = sys.argv[1] + "/" + name
    nib.save(image, path)
    back = np.asarray(nib.load(path).dataobj).astype(np.float32)
    back.ravel(order="F").tofile(path + ".expected")
for order, word in (("<", "le"), (">", "be")):
    for code in ("u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"):
        kind = np.dtype(code)
        values = (rng.normal(size=shape) * 50).astype(kind) if kind.kind == "f" else rng.integers(0, 120, shape, kind)
        save(code + word + ".nii", values, nib.Nifti1Image, order)
        save(code + word + ".nii.gz", values, nib.Nifti1Image, order)
        save(code + word + "2.nii.gz", values, nib.Nifti2Image, order)
    save("pair" + word + ".hdr", rng.integers(-99, 99, shape, np.int16), nib.Nifti1Pair, order)
)";
  ASSERT_TRUE(run_python(script, scratch.path("")));
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scratch.path(""))) {
    const std::string expected_path = entry.path();
    if (entry.path().extension() != ".expected") continue;
    const std::string path = expected_path.substr(0, expected_path.size() - std::string(".expected").size());
    SCOPED_TRACE(path);
    ++files;
    const auto source = open_source(path, {});
    EXPECT_EQ(source->info().extent, (Index3{9, 7, 5}));
    EXPECT_EQ(source->info().spacing, (std::array<double, 3>{0.5, 0.75, 2}));
    EXPECT_EQ(source->info().origin, (std::array<double, 3>{-10, 20.5, 3}));
    std::vector<float> expected(9 * 7 * 5);
    std::ifstream file(expected_path, std::ios::binary);
    file.read(reinterpret_cast<char*>(expected.data()), static_cast<std::streamsize>(expected.size() * sizeof(float)));
    ASSERT_TRUE(file.good());
    EXPECT_EQ(read_volume(*source), expected);
  }
  EXPECT_EQ(files, 2 * (10 * 3 + 1));
}

}  // namespace
}  // namespace weir::nifti_source_test
