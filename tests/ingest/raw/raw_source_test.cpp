#include "ingest/raw/raw_source.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <thread>

#include "ingest/plan/staging.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"

namespace weir::raw_source_test {
namespace {

const Index3 kExtent{7, 5, 9};
constexpr std::size_t kVoxels = 7 * 5 * 9;

/// Returns 0, 1, 2, ... 125, 0, 1, ...: values in the range of every type.
template <typename T>
std::vector<T> ramp(std::size_t count = kVoxels) {
  std::vector<T> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(i % 126);
  return values;
}

std::vector<float> read(VolumeSource& source, const Box& box) {
  std::vector<float> values(static_cast<std::size_t>(box.voxels()), -1.0F);
  source.read(box, values);
  return values;
}

std::string refusal(ErrorKind kind, const std::string& path, const SourceOptions& options = {}) {
  return message_of_error(kind, [&] { open_raw(path, options); });
}

SourceOptions options_of(const Index3& extent, ScalarType type) {
  SourceOptions options;
  options.extent = extent;
  options.type = type;
  return options;
}

template <typename T>
void expect_type(const std::string& type) {
  const Scratch scratch;
  for (const bool big : {false, true}) {
    auto values = ramp<T>();
    if (big != (std::endian::native == std::endian::big)) {
      for (T& v : values) {
        auto* bytes = reinterpret_cast<unsigned char*>(&v);
        std::reverse(bytes, bytes + sizeof v);
      }
    }
    const std::string path = scratch.write_values("v_7x5x9_" + type + (big ? "be" : "") + ".raw", values);
    const auto source = open_raw(path, {});
    EXPECT_EQ(scalar_name(source->info().type), type);
    EXPECT_EQ(source->access().bytes_per_voxel, sizeof(T));
    EXPECT_EQ(read(*source, source->info().domain()), ramp<float>()) << path;
  }
}

TEST(RawSource, AllTypesInBothByteOrders) {
  expect_type<std::uint8_t>("uint8");
  expect_type<std::int8_t>("int8");
  expect_type<std::uint16_t>("uint16");
  expect_type<std::int16_t>("int16");
  expect_type<std::uint32_t>("uint32");
  expect_type<std::int32_t>("int32");
  expect_type<float>("float32");
  expect_type<double>("float64");
}

TEST(RawSource, InfoDescribesTheFile) {
  const Scratch scratch;
  const std::string path = scratch.write_values("v.raw", ramp<std::int16_t>(), 10);
  SourceOptions options = options_of(kExtent, ScalarType::int16);
  options.offset = 10;
  const auto source = open_raw(path, options);
  const SourceInfo& info = source->info();
  EXPECT_EQ(info.path, path);
  EXPECT_EQ(info.format, "raw");
  EXPECT_EQ(info.dataset, "");
  EXPECT_EQ(info.extent, kExtent);
  EXPECT_EQ(info.index_origin, (Index3{}));
  EXPECT_EQ(info.spacing, (std::array<double, 3>{1.0, 1.0, 1.0}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{0.0, 0.0, 0.0}));
  EXPECT_EQ(info.file_bytes, 10U + 2 * kVoxels);
  EXPECT_GT(info.mtime_ns, 0);
  EXPECT_EQ(source->bytes_read(), 0U);
  EXPECT_EQ(read(*source, info.domain()), ramp<float>());
  EXPECT_GE(source->bytes_read(), 2 * kVoxels);
}

TEST(RawSource, AnyBoxInAnyMode) {
  const Scratch scratch;
  const std::string path = scratch.write_values("v_7x5x9_uint16.raw", ramp<std::uint16_t>());
  const auto all = ramp<float>();
  for (const DirectIo mode : {DirectIo::automatic, DirectIo::on, DirectIo::off}) {
    SourceOptions options;
    options.direct_io = mode;
    const auto source = open_raw(path, options);
    for (const Box& box : {Box{{0, 0, 0}, {7, 5, 9}}, Box{{0, 0, 3}, {7, 5, 4}}, Box{{0, 1, 2}, {7, 3, 8}},
                           Box{{2, 1, 3}, {6, 4, 8}}, Box{{6, 4, 8}, {7, 5, 9}}}) {
      const auto values = read(*source, box);
      std::size_t i = 0;
      for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
        for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
          for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
            ASSERT_EQ(values[i++], all[static_cast<std::size_t>(linear_index({x, y, z}, kExtent))]);
          }
        }
      }
    }
  }
}

TEST(RawSource, ManyPiecesOnManyThreads) {
  // The volume is larger than one piece, and its header of 3 bytes puts every value off its alignment.
  const Scratch scratch;
  const Index3 extent{512, 256, 24};
  std::vector<float> values(static_cast<std::size_t>(volume(extent)));
  std::iota(values.begin(), values.end(), 0.0F);
  const std::string path = scratch.write_values("big.raw", values, 3);
  SourceOptions options = options_of(extent, ScalarType::float32);
  options.offset = 3;
  ASSERT_GT(values.size() * 4, kStagingBytes);
  for (const DirectIo mode : {DirectIo::automatic, DirectIo::on, DirectIo::off}) {
    options.direct_io = mode;
    const auto source = open_raw(path, options);
    EXPECT_EQ(read(*source, source->info().domain()), values);
    // Several threads read at once and share the staging memory.
    std::vector<std::jthread> threads;
    for (std::int64_t z = 0; z < 24; z += 6) {
      threads.emplace_back([&, z] {
        const auto slab = read(*source, {{0, 0, z}, {512, 256, z + 6}});
        EXPECT_TRUE(std::equal(slab.begin(), slab.end(), values.begin() + z * 512 * 256));
      });
    }
  }
}

TEST(RawSource, LossIsCountedOverTheBox) {
  const Scratch scratch;
  std::vector<double> values(kVoxels, 1.0);
  values[0] = 0.1;
  values[200] = 1e300;
  const auto source = open_raw(scratch.write_values("v_7x5x9_float64.raw", values), {});
  std::vector<float> out(kVoxels);
  const ConversionLoss loss = source->read(source->info().domain(), out);
  EXPECT_EQ(loss.inexact, 1U);
  EXPECT_EQ(loss.overflow, 1U);
  EXPECT_EQ(loss.max_abs_error, static_cast<double>(0.1F) - 0.1);
  const ConversionLoss part = source->read({{0, 0, 1}, {7, 5, 2}}, std::span(out).first(35));
  EXPECT_EQ(part.inexact + part.overflow, 0U);
}

TEST(RawSource, OptionsThatContradictTheNameAreRefused) {
  const Scratch scratch;
  const std::string path = scratch.write_values("v_7x5x9_float32be.raw", ramp<float>());
  SourceOptions options = options_of(kExtent, ScalarType::float32);
  options.big_endian = true;
  EXPECT_EQ(open_raw(path, options)->info().extent, kExtent);

  options.extent = Index3{7, 9, 5};
  EXPECT_EQ(refusal(ErrorKind::usage, path, options),
            path + ": --dims 7,9,5 contradicts the file's name, which says 7x5x9; drop it or rename the file");
  options.extent.reset();
  options.type = ScalarType::int32;
  EXPECT_EQ(refusal(ErrorKind::usage, path, options),
            path + ": --type int32 contradicts the file's name, which says float32; drop it or rename the file");
  options.type.reset();
  options.big_endian = false;
  EXPECT_EQ(refusal(ErrorKind::usage, path, options),
            path + ": --endian little contradicts the file's name, which says float32be; drop it or rename the file");
}

TEST(RawSource, ByteOrderMayBeGivenWhereTheNameSaysNone) {
  const Scratch scratch;
  const std::string path =
      scratch.write("v_1x1x2_int16.raw", std::vector<std::byte>{std::byte{1}, {}, {}, std::byte{1}});
  EXPECT_EQ(read(*open_raw(path, {}), {{0, 0, 0}, {1, 1, 2}}), (std::vector<float>{1.0F, 256.0F}));
  SourceOptions options;
  options.big_endian = true;
  EXPECT_EQ(read(*open_raw(path, options), {{0, 0, 0}, {1, 1, 2}}), (std::vector<float>{256.0F, 1.0F}));
}

TEST(RawSource, SizeMustMatch) {
  const Scratch scratch;
  const std::string shorter = scratch.write_values("s_7x5x9_float32.raw", ramp<float>(kVoxels - 1));
  EXPECT_EQ(refusal(ErrorKind::input, shorter),
            shorter + ": 4 bytes too short: 7x5x9 float32 after an offset of 0 needs 1260 bytes, the file has 1256; " +
                "check --dims, --type and --offset");
  const std::string longer = scratch.write_values("l_7x5x9_uint8.raw", ramp<std::uint8_t>(), 1);
  EXPECT_EQ(refusal(ErrorKind::input, longer),
            longer + ": 1 byte too long: 7x5x9 uint8 after an offset of 0 needs 315 bytes, the file has 316; " +
                "check --dims, --type and --offset");
  SourceOptions options;
  options.offset = 1;
  EXPECT_EQ(open_raw(longer, options)->info().extent, kExtent);
  options.offset = UINT64_MAX;
  EXPECT_NE(refusal(ErrorKind::input, longer, options).find(" bytes too short: "), std::string::npos);
}

TEST(RawSource, MissingEmptyDirectory) {
  const Scratch scratch;
  const std::string missing = scratch.path("m_4x4x4_uint8.raw");
  EXPECT_EQ(refusal(ErrorKind::input, missing), missing + ": cannot open for reading: No such file or directory");
  const std::string empty = scratch.write("e_4x4x4_uint8.raw", {});
  EXPECT_EQ(refusal(ErrorKind::input, empty), empty + ": is empty (0 bytes); copy it again, or write it anew");
  const std::string directory = scratch.path("d_4x4x4_uint8.raw");
  std::filesystem::create_directory(directory);
  EXPECT_EQ(refusal(ErrorKind::input, directory), directory + ": is a directory; name a file in it");
}

TEST(RawSource, ImpossibleExtents) {
  const Scratch scratch;
  const std::string path = scratch.write_values("v.raw", ramp<std::uint8_t>());
  const auto with = [&](const Index3& extent) {
    return refusal(ErrorKind::input, path, options_of(extent, ScalarType::uint8));
  };
  EXPECT_EQ(with({7, 0, 9}), path + ": extent 7x0x9 has 0 voxels along y; each axis must be 1 to 2147483647");
  EXPECT_EQ(with({7, 5, -9}), path + ": extent 7x5x-9 has -9 voxels along z; each axis must be 1 to 2147483647");
  EXPECT_EQ(with({2147483648, 1, 1}),
            path + ": extent 2147483648x1x1 has 2147483648 voxels along x; each axis must be 1 to 2147483647");
  EXPECT_EQ(with({2147483647, 2147483647, 2147483647}),
            path + ": extent 2147483647x2147483647x2147483647 at 4 bytes a voxel overflows 64 bits; check the extent");
  const std::string named = scratch.write_values("v_0x5x9_uint8.raw", ramp<std::uint8_t>());
  EXPECT_EQ(refusal(ErrorKind::input, named),
            named + ": extent 0x5x9 has 0 voxels along x; each axis must be 1 to 2147483647");
}

TEST(RawSource, FileThatIsPackedByGzip_IsToBeUnpacked) {
  const Scratch scratch;
  const std::string path =
      scratch.write("v_7x5x9_uint8.raw.gz", std::vector{std::byte{0x1F}, std::byte{0x8B}, std::byte{8}});
  EXPECT_EQ(refusal(ErrorKind::input, path), path + ": is packed by gzip; unpack it first, with gunzip -k");
}

TEST(RawSource, FileThatIsPackedByXzBzip2OrZstd_IsToBeUnpacked) {
  const Scratch scratch;
  const auto refused = [&](const std::string& suffix, const std::vector<int>& head) {
    std::vector<std::byte> bytes;
    for (const int byte : head) bytes.push_back(static_cast<std::byte>(byte));
    const std::string path = scratch.write("v_7x5x9_uint8.raw" + suffix, bytes);
    return refusal(ErrorKind::input, path).substr(path.size());
  };
  EXPECT_EQ(refused(".xz", {0xFD, '7', 'z', 'X', 'Z', 0}), ": is packed by xz; unpack it first, with xz -dk");
  EXPECT_EQ(refused(".bz2", {'B', 'Z', 'h', '9'}), ": is packed by bzip2; unpack it first, with bunzip2 -k");
  EXPECT_EQ(refused(".ZST", {0x28, 0xB5, 0x2F, 0xFD, 4}), ": is packed by zstd; unpack it first, with zstd -d");
}

// The header of a numpy file of version 1 is padded to 128 bytes.
TEST(RawSource, ArrayOfNumpy_IsRefusedUnlessDimsAreGiven) {
  const Scratch scratch;
  const std::string remedy =
      ": is an array of numpy, which weir's module for Python converts: weir.convert(numpy.load(PATH), OUTPUT)";
  for (const std::string name : {"v.npy", "V.NPY", "v.npz"}) {
    const std::string path = scratch.write_values(name, ramp<float>(), 128);
    SourceOptions options;
    EXPECT_EQ(refusal(ErrorKind::input, path, options), path + remedy);
    options.type = ScalarType::float32;
    options.offset = 128;
    EXPECT_EQ(refusal(ErrorKind::input, path, options), path + remedy);
    options.extent = kExtent;
    const auto source = open_source(path, options);
    EXPECT_EQ(source->info().format, "raw");
    EXPECT_EQ(read(*source, source->info().domain()), ramp<float>());
  }
}

TEST(RawSource, UnknownExtentOrTypeIsAskedFor) {
  const Scratch scratch;
  const std::string path = scratch.write_values("v.raw", ramp<std::uint8_t>());
  EXPECT_EQ(refusal(ErrorKind::usage, path),
            path + ": extent unknown; give --dims X,Y,Z and --type or name the file NAME_XxYxZ_TYPE.raw");
  SourceOptions options;
  options.extent = kExtent;
  const std::string types =
      "uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, bfloat16, float32, float64";
  EXPECT_EQ(scalar_names(), types);
  EXPECT_EQ(refusal(ErrorKind::usage, path, options), path + ": type unknown; give --type with one of " + types);
  const std::string named = scratch.write_values("v_7x5x9_byte.raw", ramp<std::uint8_t>());
  EXPECT_EQ(refusal(ErrorKind::usage, named),
            named + ": unknown type 'byte' in the file's name; give --type with one of " + types);
  options.type = ScalarType::uint8;
  EXPECT_EQ(open_raw(named, options)->info().type, ScalarType::uint8);
}

TEST(RawSource, BoxesOutsideTheVolumeAreAnInternalError) {
  const Scratch scratch;
  const auto source = open_raw(scratch.write_values("v_7x5x9_uint8.raw", ramp<std::uint8_t>()), {});
  std::vector<float> values(1);
  EXPECT_EQ(message_of_error(ErrorKind::internal,
                             [&] {
                               source->read({{7, 0, 0}, {8, 1, 1}}, values);
                             }),
            source->info().path + ": read of box 7:8,0:1,0:1 into 1 values does not fit 0:7,0:5,0:9");
  message_of_error(ErrorKind::internal, [&] { source->read({{0, 0, 0}, {2, 1, 1}}, values); });
  message_of_error(ErrorKind::internal, [&] { source->read({{0, 0, 0}, {0, 1, 1}}, values); });
}

TEST(RawSource, AFileCutAfterOpening) {
  const Scratch scratch;
  const std::string path = scratch.write_values("v_7x5x9_uint8.raw", ramp<std::uint8_t>());
  const auto source = open_raw(path, {});
  std::filesystem::resize_file(path, 100);
  std::vector<float> values(kVoxels);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { source->read(source->info().domain(), values); }),
            path + ": the file ended at offset 100 while reading 315 bytes at offset 0; it had 315 bytes when it was " +
                "opened: it was cut while being read");
}

}  // namespace
}  // namespace weir::raw_source_test
