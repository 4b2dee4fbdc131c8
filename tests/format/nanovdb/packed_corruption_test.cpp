// Every check of packed data, by the damage that trips it and the message it gives.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_grid.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_grid.h"

namespace weir::packed_corruption_test {
namespace {

namespace header = packed::header;
namespace chunk = packed::chunk;
using test::PackedFile;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// One region with two streams in group 0: 5 bytes (constant) at position 0, 2049 bytes (raw) at position 1.
const PackedFile& sample() {
  static const PackedFile made = [] {
    test::PackedGridOptions options;
    options.domain = {{0, 0, 0}, {8, 8, 24}};
    options.stream = [](const Index3& block) {
      static const std::array<float, kLeafVoxels> kZeros{};
      return block.z == 0 ? test::constant_stream(1.5F) : block.z == 1 ? test::raw_stream(kZeros) : test::PackedBytes{};
    };
    return test::PackedGridBuilder::build(options);
  }();
  return made;
}

class Damage {
 public:
  template <typename T>
  Damage& put(std::uint64_t offset, T value) {
    store(std::span(made_.file), made_.packed + offset, value);
    return *this;
  }
  template <typename T>
  Damage& in_chunk(std::uint64_t offset, T value) {
    store(std::span(made_.file), made_.chunks.at(0) + offset, value);
    return *this;
  }
  template <typename T>
  Damage& in_record(std::uint64_t offset, T value) {
    store(std::span(made_.file), made_.record + offset, value);
    return *this;
  }
  Damage& named(const std::string& name) {
    std::memcpy(made_.file.data() + made_.record + nvdb::blind::kName, name.c_str(), name.size() + 1);
    return *this;
  }

  // What opening says, or reading all of the volume.
  std::string message() const {
    return message_of_error(ErrorKind::input, [&] {
      const NvdbGrid grid = NvdbGrid::open(made_.file, "a.nvdb");
      std::array<float, kLeafVoxels> values;
      grid.for_each_block([&](const GridBlock& block) { grid.decode_block(block, values); });
    });
  }
  std::string message_of_look_up(const Index3& i) const {
    return message_of_error(ErrorKind::input, [&] { NvdbGrid::open(made_.file, "a.nvdb").value(i); });
  }

 private:
  PackedFile made_ = sample();
};

std::string at(std::uint64_t offset, const std::string& what) {
  return cat("a.nvdb: at byte ", sample().packed + offset, ": ", what);
}
std::string at_chunk(std::uint64_t offset, const std::string& what) {
  return cat("a.nvdb: at byte ", sample().chunks.at(0) + offset, ": ", what);
}
std::string at_record(std::uint64_t offset, const std::string& what) {
  return cat("a.nvdb: at byte ", sample().record + offset, ": ", what);
}

std::uint64_t bytes() { return sample().file.size() - sample().packed; }
std::uint64_t chunk_bytes() { return sample().packed + bytes() - sample().chunks.at(0); }
constexpr std::uint64_t kEntry = packed::kRegionsOffset;

TEST(PackedCorruption, Sample_Opens) {
  const NvdbGrid grid = NvdbGrid::open(sample().file, "a.nvdb");
  EXPECT_EQ(grid.value({0, 0, 0}), 1.5F);
  EXPECT_EQ(grid.value({0, 0, 8}), 0.0F);
}

TEST(PackedCorruption, Record) {
  EXPECT_EQ(Damage().named("weir_packed:2").message(),
            at_record(32, "packed data \"weir_packed:2\", and this weir reads \"weir_packed:1\"; use a newer one"));
  EXPECT_EQ(Damage().in_record(nvdb::blind::kType, 2).in_record(nvdb::blind::kCount, std::uint64_t{1}).message(),
            at_record(28, "packed data of type 2 instead of float"));
  EXPECT_EQ(Damage().in_record(nvdb::blind::kCount, std::uint64_t{0}).message(),
            at_record(8, "packed data of 0 bytes"));
  EXPECT_EQ(Damage().in_record(nvdb::blind::kCount, std::uint64_t{23}).message(),
            at(0, "packed data of 92 bytes, less than its header's 96"));
}

TEST(PackedCorruption, Header) {
  EXPECT_EQ(Damage().put(header::kVersion, 2U).message(),
            at(8, "packed data of version 2, and this weir reads version 1; use a newer one"));
  EXPECT_EQ(Damage().put(header::kBytes, bytes() + 4).message(),
            at(0, cat("the packed data says ", bytes() + 4, " bytes, its record ", bytes())));
  EXPECT_EQ(Damage().put(header::kFlags, 6U).message(), at(12, "unknown flags 0x00000006"));
  EXPECT_EQ(Damage().put(header::kFirstRegion + 4, -1).message(),
            at(16, "the first region is (0, -1, 0), the index box begins in (0, 0, 0)"));
  EXPECT_EQ(Damage().put(header::kRegionCount + 8, 0xFFFFFFFFU).message(),
            at(28, "there are (1, 1, 4294967295) regions, the index box lies in (1, 1, 1)"));
  EXPECT_EQ(Damage().put(header::kMinimum, kNan).message(), at(40, "minimum nan is not finite"));
  EXPECT_EQ(Damage().put(header::kMaximum, -2000.0F).message(), at(44, "maximum -2000 is below minimum -1000"));
  EXPECT_EQ(Damage().put(header::kCoarsest, 251).message(),
            at(48, "the coarsest step is 251, it must be from -250 to 250"));
  EXPECT_EQ(Damage().put(header::kLatticeMinimum, kNan).message(), at(52, "lattice minimum nan is not finite"));
  EXPECT_EQ(Damage().put(header::kLatticeQuantum, kNan).message(), at(56, "lattice quantum nan is not finite"));
  EXPECT_EQ(Damage().put(header::kLatticeBits, 25U).message(), at(60, "codes of 25 bits on the lattice, at most 24"));
  EXPECT_EQ(Damage().put(header::kBelowOne, kNan).message(), at(64, "recovery point nan is not finite"));
  EXPECT_EQ(Damage().put(header::kBelowMore, kNan).message(), at(68, "recovery point nan is not finite"));
}

TEST(PackedCorruption, Tables) {
  EXPECT_EQ(Damage().put(header::kTableCount, 119U).message(), at(76, "119 tables of frequencies instead of 120"));
  for (const std::uint32_t place : {92U, 98U, 0xFFFFFFFCU}) {
    EXPECT_EQ(
        Damage().put(header::kTables, place).message(),
        at(72, cat("tables at offset ", place, ", not a multiple of 4 between the header and the end at ", bytes())));
  }
  EXPECT_EQ(Damage().put(96 + 32, std::uint16_t{1}).message(),
            at(96 + 32, "cumulative frequency 0 of table 1 is 1, not 0"));
  EXPECT_EQ(Damage().put(96 + 4, std::uint16_t{256}).message(),
            at(96 + 4, "cumulative frequency 2 of table 0 is 256, not between 256 and 4096"));
  EXPECT_EQ(Damage().put(96 + 30, std::uint16_t{4096}).message(),
            at(96 + 30, "cumulative frequency 15 of table 0 is 4096, not between 3584 and 4096"));
}

TEST(PackedCorruption, RegionTable) {
  for (const std::uint64_t place : {std::uint64_t{88}, std::uint64_t{100}, bytes(), ~std::uint64_t{7}}) {
    EXPECT_EQ(Damage().put(header::kRegions, place).message(),
              at(80, cat("the region table at offset ", place,
                         " with (1, 1, 1) entries does not lie between the header and the end at ", bytes())));
  }
  EXPECT_EQ(Damage().put(kEntry, std::uint64_t{0}).message(),
            at(kEntry + 12, cat("region (0, 0, 0) has no chunk, but ", chunk_bytes(), " bytes")));
  for (const std::uint64_t place : {std::uint64_t{4}, kEntry + 18, bytes() - 4, ~std::uint64_t{3}}) {
    EXPECT_EQ(Damage().put(kEntry, place).message(),
              at(kEntry, cat("the chunk of region (0, 0, 0), ", chunk_bytes(), " bytes at offset ", place,
                             ", does not lie between the header and the end at ", bytes())));
  }
  for (const std::uint32_t size : {1544U, 1550U, 0U}) {
    EXPECT_EQ(Damage().put(kEntry + 12, size).message(), at(kEntry + 12, cat("the chunk of region (0, 0, 0) has ", size,
                                                                             " bytes, not a multiple of 4 from 1548")));
  }
}

TEST(PackedCorruption, Directory) {
  EXPECT_EQ(Damage().in_chunk(chunk::kMeanLow, kNan).message(),
            at_chunk(0, "the range of means is nan to 1, not one of finite values"));
  EXPECT_EQ(Damage().in_chunk(chunk::kMeanLow, 2.0F).message_of_look_up({0, 0, 0}),
            at_chunk(0, "the range of means is 2 to 1, not one of finite values"));
  EXPECT_EQ(Damage().in_chunk(chunk::kBases, 1544U).message(),
            at_chunk(8, cat("group 0 of blocks lies in bytes 1544 to ", chunk_bytes() - 2,
                            " of a chunk whose groups lie in bytes 1548 to ", chunk_bytes())));
  EXPECT_EQ(Damage().in_chunk(chunk::kBases + 4, 0xFFFFFFFFU).message_of_look_up({0, 0, 8}),
            at_chunk(8, cat("group 0 of blocks lies in bytes 1548 to 4294967295 of a chunk whose groups lie in bytes ",
                            "1548 to ", chunk_bytes())));
  EXPECT_EQ(Damage().in_chunk(chunk::kBases + 4, 1550U).message(),
            at_chunk(8, "group 0 of blocks has 2 bytes, its directory alone 4"));
}

TEST(PackedCorruption, Ends) {
  const std::uint64_t group = 4 + 5 + 2049;
  const auto text = [&](int stream, int begin, int end) {
    return at_chunk(chunk::kGroups + 2 * static_cast<std::uint64_t>(stream),
                    cat("stream ", stream, " of 2 lies in bytes ", begin, " to ", end,
                        " of a group whose streams lie in bytes 4 to ", group));
  };
  EXPECT_EQ(Damage().in_chunk(chunk::kGroups, std::uint16_t{4}).message(), text(0, 4, 4));
  EXPECT_EQ(Damage().in_chunk(chunk::kGroups, std::uint16_t{3}).message_of_look_up({0, 0, 8}), text(1, 3, 2058));
  EXPECT_EQ(Damage().in_chunk(chunk::kGroups + 2, std::uint16_t{2059}).message(), text(1, 9, 2059));
  EXPECT_EQ(Damage().in_chunk(chunk::kGroups + 2, std::uint16_t{8}).message(), text(1, 9, 8));
}

TEST(PackedCorruption, Stream) {
  EXPECT_EQ(Damage().in_chunk(chunk::kGroups + 4, std::byte{3}).message(),
            at_chunk(chunk::kGroups + 4, "a block's stream of 5 bytes and kind 3 is damaged"));
  EXPECT_EQ(Damage().in_chunk(chunk::kGroups + 4, std::byte{3}).message_of_look_up({7, 7, 7}),
            at_chunk(chunk::kGroups + 4, "a block's stream of 5 bytes and kind 3 is damaged"));
}

TEST(PackedCorruption, FileCutAnywhere_IsRefused) {
  for (std::uint64_t bytes = 0; bytes < sample().file.size(); bytes += 97) {
    const std::span<const std::byte> cut(sample().file.data(), bytes);
    EXPECT_NE(message_of_error(ErrorKind::input, [&] { NvdbGrid::open(cut, "a.nvdb"); }), "");
  }
}

TEST(PackedCorruption, TypeOfTheGrid) {
  PackedFile made = sample();
  const auto fpn = static_cast<std::uint32_t>(GridType::fpn);
  store(std::span(made.file), nvdb::meta::kGridType, fpn);
  store(std::span(made.file), 4096 + nvdb::grid::kGridType, fpn);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { NvdbGrid::open(made.file, "a.nvdb"); }),
            "a.nvdb: at byte 4732: packed data in a grid of type fpn instead of float32");
}

}  // namespace
}  // namespace weir::packed_corruption_test
