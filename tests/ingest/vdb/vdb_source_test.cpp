#include "ingest/vdb/vdb_source.h"

#include <array>
#include <filesystem>
#include <thread>

#include "format/base/text.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/header_file.h"
#include "tests/stock/openvdb_file.h"
#include "tests/stock/stock_nvdb.h"
#include "tests/support/sanitized.h"

namespace weir::vdb_source_test {
namespace {

using test::Compression;
using test::GridKind;
using test::OpenVdbGrid;

/// Returns a grid with leaves on both sides of the edges of every kind of node, an inactive voxel with a value of its
/// own, and active and inactive tiles.
OpenVdbGrid full_grid(GridKind kind) {
  OpenVdbGrid grid(kind, "density");
  grid.fill({{-13, -5, -9}, {21, 12, 13}}).fill({{120, 0, 0}, {133, 9, 9}});
  grid.set_off({-12, -4, -8}, 77).set_off({40, 8, 8}, 5);
  grid.tile(1, {64, 64, 64}, 3, true).tile(1, {72, 64, 64}, -6, false).tile(1, {24, 16, 8}, 9, true);
  return grid;
}

SourceOptions naming(const std::string& dataset) {
  SourceOptions options;
  options.dataset = dataset;
  return options;
}

/// Compares every voxel of the source's domain with OpenVDB's own accessor.
void expect_same(VolumeSource& source, const OpenVdbGrid& grid) {
  const Box domain = grid.active();
  ASSERT_EQ(source.info().domain(), domain);
  const std::vector<float> values = read_volume(source);
  std::size_t n = 0;
  for (std::int64_t z = domain.lo.z; z < domain.hi.z; ++z) {
    for (std::int64_t y = domain.lo.y; y < domain.hi.y; ++y) {
      for (std::int64_t x = domain.lo.x; x < domain.hi.x; ++x) {
        const auto expected = static_cast<float>(grid.value({x, y, z}));
        ASSERT_EQ(values[n++], expected) << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(VdbSource, ReadsEveryTypeByEveryCompression) {
  const Scratch scratch;
  const std::vector<std::pair<GridKind, ScalarType>> types{
      {GridKind::float32, ScalarType::float32}, {GridKind::float64, ScalarType::float64},
      {GridKind::int32, ScalarType::int32},     {GridKind::int64, ScalarType::int64},
      {GridKind::boolean, ScalarType::uint8},   {GridKind::mask, ScalarType::uint8}};
  for (const auto& [kind, scalar] : types) {
    const OpenVdbGrid grid = full_grid(kind);
    for (const auto compression : {Compression::none, Compression::active_mask, Compression::zip,
                                   Compression::zip_active_mask, Compression::blosc, Compression::blosc_active_mask}) {
      SCOPED_TRACE(cat(scalar_name(scalar), " by ", static_cast<int>(compression)));
      const std::string path = scratch.path("a.vdb");
      test::write_vdb(path, {grid}, compression);
      const auto source = open_source(path, {});
      EXPECT_EQ(source->info().format, "openvdb");
      EXPECT_EQ(source->info().dataset, "density");
      EXPECT_EQ(source->info().type, scalar);
      EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(path));
      expect_same(*source, grid);
    }
  }
}

TEST(VdbSource, ReadsRealsSavedAsHalf) {
  const Scratch scratch;
  for (const GridKind kind : {GridKind::float32, GridKind::float64}) {
    for (const auto compression :
         {Compression::none, Compression::active_mask, Compression::zip_active_mask, Compression::blosc_active_mask}) {
      // Multiples of 1/8 up to 256 are exact in float16.
      OpenVdbGrid grid(kind, "a");
      grid.fill({{-9, 0, 0}, {9, 9, 9}}).tile(1, {16, 0, 0}, -6, true).save_as_half();
      test::write_vdb(scratch.path("a.vdb"), {grid}, compression);
      expect_same(*open_source(scratch.path("a.vdb"), {}), grid);
    }
  }
}

TEST(VdbSource, ActiveTilesOfEveryLevelBelongToTheDomain) {
  const Scratch scratch;
  OpenVdbGrid grid(GridKind::float32, "a");
  grid.fill({{130, -3, 5}, {131, -2, 6}}).tile(2, {0, -128, 0}, 4, true);
  test::write_vdb(scratch.path("a.vdb"), {grid});
  expect_same(*open_source(scratch.path("a.vdb"), {}), grid);

  OpenVdbGrid root(GridKind::int32, "root");
  root.tile(3, {-4096, 0, 4096}, 11, true);
  test::write_vdb(scratch.path("root.vdb"), {root});
  SourceOptions options;
  options.roi = Box{{-4096, 4095, 4096}, {-4094, 4096, 4097}};
  const auto source = open_source(scratch.path("root.vdb"), options);
  EXPECT_EQ(read_volume(*source), (std::vector<float>{11, 11}));
  EXPECT_EQ(open_source(scratch.path("root.vdb"), {})->info().domain(), (Box{{-4096, 0, 4096}, {0, 4096, 8192}}));
}

TEST(VdbSource, BoxesReadTheSameAloneAndFromSeveralThreads) {
  const Scratch scratch;
  test::write_vdb(scratch.path("a.vdb"), {full_grid(GridKind::float64)});
  const auto source = open_source(scratch.path("a.vdb"), {});
  EXPECT_TRUE(source->in_memory());
  const Box domain = source->info().domain();
  const std::vector<float> all = read_volume(*source);
  const std::vector<Box> boxes{{{-13, -5, -9}, {-12, -4, -8}},
                               {{-1, -1, -1}, {1, 1, 1}},
                               {{-9, 3, -9}, {72, 66, 70}},
                               {{7, 7, 7}, {9, 72, 72}},
                               domain};
  std::vector<std::jthread> threads;
  for (const Box& box : boxes) {
    threads.emplace_back([&source, &all, domain, box] {
      std::vector<float> together(static_cast<std::size_t>(box.voxels()), -1.0F);
      std::vector<float> alone(together);
      source->read(box, together);
      source->read_alone(box, alone);
      EXPECT_EQ(together, alone);
      std::size_t n = 0;
      for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
        for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
          for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
            const auto at = linear_index(Index3{x, y, z} - domain.lo, domain.extent());
            ASSERT_EQ(alone[n++], all[static_cast<std::size_t>(at)]);
          }
        }
      }
    });
  }
}

TEST(VdbSource, CountsWhatFloat32LosesOncePerVoxel) {
  const Scratch scratch;
  OpenVdbGrid grid(GridKind::int32, "a");
  grid.fill({{5, 5, 5}, {10, 10, 10}}, (1 << 24) + 1.0);  // x + 3 y - 7 z + 2^24 + 1: too large for all to be exact
  test::write_vdb(scratch.path("a.vdb"), {grid});
  const auto source = open_source(scratch.path("a.vdb"), {});
  std::vector<float> values(125);
  const ConversionLoss loss = source->read(source->info().domain(), values);
  std::uint64_t inexact = 0;
  for (std::int64_t i = 0; i < 125; ++i) {
    const double exact = grid.value(index_at(i, {5, 5, 5}) + Index3{5, 5, 5});
    inexact += static_cast<double>(values[static_cast<std::size_t>(i)]) != exact ? 1U : 0U;
  }
  EXPECT_GT(inexact, 0U);
  EXPECT_EQ(loss.inexact, inexact);
}

TEST(VdbSource, MissingIsAStoredValue) {
  const Scratch scratch;
  OpenVdbGrid grid(GridKind::int64, "a");
  grid.fill({{0, 0, 0}, {3, 1, 1}});  // 0, 1, 2
  test::write_vdb(scratch.path("a.vdb"), {grid});
  SourceOptions options;
  options.missing = StoredValue{std::int64_t{1}};
  const auto values = read_volume(*open_source(scratch.path("a.vdb"), options));
  EXPECT_EQ(values[0], 0.0F);
  EXPECT_TRUE(is_missing(values[1]));
  EXPECT_EQ(values[2], 2.0F);
}

// OpenVDB, "Transforms and Maps": an index (i, j, k) is the centre of its voxel, and the map gives its world position.
TEST(VdbSource, TransformsBecomeSpacingAndOriginOfVoxelCentres) {
  const Scratch scratch;
  const auto placed = [&](OpenVdbGrid grid) {
    test::write_vdb(scratch.path("a.vdb"), {grid.fill({{-2, 0, 1}, {0, 2, 3}})});
    return open_source(scratch.path("a.vdb"), {})->info();
  };
  using Three = std::array<double, 3>;
  const OpenVdbGrid identity(GridKind::float32, "a");
  EXPECT_EQ(placed(identity).spacing, (Three{1, 1, 1}));
  const SourceInfo scaled = placed(OpenVdbGrid(GridKind::float32, "a").place({0.5, 0.25, 2}, {10, -20, 30}));
  EXPECT_EQ(scaled.spacing, (Three{0.5, 0.25, 2}));
  EXPECT_EQ(scaled.origin, (Three{10, -20, 30})) << "of index 0,0,0, not of the first voxel";
  EXPECT_EQ(scaled.index_origin, (Index3{-2, 0, 1}));

  const SourceInfo turned = placed(OpenVdbGrid(GridKind::float32, "a").place({2, 3, 4}, {0, 0, 0}).rotate(0.5));
  EXPECT_NEAR(turned.spacing[0], 2, 1e-12);
  EXPECT_NEAR(turned.spacing[1], 3, 1e-12);
  EXPECT_NEAR(turned.spacing[2], 4, 1e-12);
  const DatasetInfo listed = list_vdb(scratch.path("a.vdb"), {}).at(0);
  const std::pair<std::string, std::string> orientation{
      "orientation", "axes oblique to the file's world, ignored: spacing is the length of a step"};
  EXPECT_NE(std::find(listed.attributes.begin(), listed.attributes.end(), orientation), listed.attributes.end());
}

TEST(VdbSource, FirstVoxelOfAFallingAxis_LiesWhereOpenVdbPutsIt) {
  const Scratch scratch;
  OpenVdbGrid grid(GridKind::float32, "a");
  grid.fill({{-9, 2, -3}, {12, 20, 15}}).place({1, 2, -3}, {10, 20, 30});
  test::write_vdb(scratch.path("a.vdb"), {grid, OpenVdbGrid(GridKind::float32, "none").place({1, 1, -1}, {4, 5, 6})});
  const SourceInfo info = open_source(scratch.path("a.vdb"), naming("a"))->info();
  EXPECT_EQ(info.spacing, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(info.index_origin, (Index3{-9, 2, -3}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{10, 20, 48})) << "first voxel at 1,24,39";
  const auto list = list_vdb(scratch.path("a.vdb"), {});
  const auto origin = [&](std::size_t i) {
    const auto& all = list.at(i).attributes;
    const auto found = std::find_if(all.begin(), all.end(), [](const auto& a) { return a.first == "origin"; });
    return found == all.end() ? std::string() : found->second;
  };
  EXPECT_EQ(origin(0), "10,20,48");
  EXPECT_EQ(origin(1), "4,5,6");
}

TEST(VdbSource, ClassAndBackgroundOfALevelSet_AreKept) {
  const Scratch scratch;
  const auto info_of = [&](GridKind kind, const std::string& grid_class, bool half = false) {
    OpenVdbGrid grid(kind, "a");
    grid.fill({{0, 0, 0}, {9, 9, 9}});
    if (!grid_class.empty()) grid.class_is(grid_class);
    if (half) grid.save_as_half();
    test::write_vdb(scratch.path("a.vdb"), {grid}, Compression::blosc_active_mask);
    SourceOptions options;
    if (kind == GridKind::vec3s) options.component = parse_component("x");
    return open_source(scratch.path("a.vdb"), options)->info();
  };
  for (const GridKind kind : {GridKind::float32, GridKind::float64}) {
    for (const bool half : {false, true}) {
      const SourceInfo level_set = info_of(kind, "level set", half);
      EXPECT_EQ(level_set.grid_class, GridClass::level_set);
      EXPECT_EQ(level_set.background, 2.0F);
    }
  }
  EXPECT_EQ(info_of(GridKind::float32, "fog volume").grid_class, GridClass::fog_volume);
  EXPECT_FALSE(info_of(GridKind::float32, "fog volume").background) << "found as of any other volume";
  EXPECT_EQ(info_of(GridKind::float32, "").grid_class, GridClass::unknown);
  EXPECT_EQ(info_of(GridKind::int32, "level set").grid_class, GridClass::unknown);
  EXPECT_EQ(info_of(GridKind::vec3s, "staggered").grid_class, GridClass::unknown);
}

TEST(VdbSource, ChoosesByName) {
  const Scratch scratch;
  const std::string path = scratch.path("a.vdb");
  const Box box{{0, 0, 0}, {2, 1, 1}};
  OpenVdbGrid density(GridKind::float32, "density");
  OpenVdbGrid second(GridKind::float32, "density");
  OpenVdbGrid heat(GridKind::int32, "heat");
  density.fill(box);
  second.fill(box, 2);
  heat.fill(box, 3);
  test::write_vdb(path, {density, second, heat, OpenVdbGrid(GridKind::points, "dust")});
  expect_same(*open_source(path, naming("density[1]")), second);
  expect_same(*open_source(path, naming("heat")), heat);
  EXPECT_EQ(
      message_of_error(ErrorKind::usage, [&] { open_source(path, {}); }),
      path + ": holds 3 grids that can be converted; name a grid with --dataset: 'density[0]', 'density[1]', 'heat'");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, naming("temp")); }),
            path + ": has no grid 'temp'; it has 'density[0]', 'density[1]', 'heat', 'dust'");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, naming("dust")); }),
            path +
                ": grid 'dust' cannot be converted: its type is 'Tree_ptdataidx32_5_4_3', and float, double, int32, "
                "int64, bool, mask, vec3s, vec3d and vec3i trees of 5_4_3 can be read");
}

TEST(VdbSource, InstancesShareATreeAndHaveTheirOwnTransform) {
  const Scratch scratch;
  OpenVdbGrid first(GridKind::float32, "first");
  first.fill({{0, 0, 0}, {4, 3, 2}});
  const OpenVdbGrid second = first.instance("second").place({2, 2, 2}, {1, 1, 1});
  test::write_vdb(scratch.path("a.vdb"), {first, second});
  const auto source = open_source(scratch.path("a.vdb"), naming("second"));
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{2, 2, 2}));
  expect_same(*source, first);
}

TEST(VdbSource, ListsGridsWithTypeLayoutAndObstacle) {
  const Scratch scratch;
  OpenVdbGrid density(GridKind::float32, "density");
  density.fill({{-66, -21, -90}, {-60, -20, -88}}).place({0.5, 0.5, 0.5}, {1, 2, 3}).save_as_half();
  const OpenVdbGrid empty(GridKind::boolean, "empty");
  OpenVdbGrid skewed(GridKind::float32, "skewed");
  skewed.fill({{0, 0, 0}, {1, 1, 1}}).frustum();
  test::write_vdb(scratch.path("a.vdb"), {density, empty, skewed, OpenVdbGrid(GridKind::points, "dust")},
                  Compression::zip_active_mask);
  const auto list = list_vdb(scratch.path("a.vdb"), {});
  ASSERT_EQ(list.size(), 4U);
  EXPECT_EQ(list[0].name, "density");
  EXPECT_EQ(list[0].extents, (std::vector<std::int64_t>{6, 1, 2}));
  EXPECT_EQ(list[0].type, "float32 saved as float16");
  EXPECT_EQ(list[0].layout, "OpenVDB tree, zip, active mask");
  EXPECT_EQ(list[0].obstacle, "");
  using Attributes = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(
      Attributes(list[0].attributes.begin(), list[0].attributes.begin() + 4),
      (Attributes{{"index origin", "-66,-21,-90"}, {"spacing", "0.5,0.5,0.5"}, {"origin", "1,2,3"}, {"leaves", "2"}}));
  EXPECT_EQ(list[0].attributes.at(4).first, "memory");
  EXPECT_EQ(list[1].type, "bool");
  EXPECT_EQ(list[1].obstacle, "it has no active voxel");
  EXPECT_EQ(list[2].obstacle,
            "its transform is a 'NonlinearFrustumMap', which has no voxel size; resample it to a linear one");
  EXPECT_EQ(list[3].type, "Tree_ptdataidx32_5_4_3");
}

TEST(VdbSource, RefusesWhatMemoryDoesNotHold) {
  const Scratch scratch;
  OpenVdbGrid grid(GridKind::float64, "a");
  grid.fill({{0, 0, 0}, {128, 128, 64}});
  test::write_vdb(scratch.path("a.vdb"), {grid});
  SourceOptions options;
  options.memory = std::uint64_t{4} << 20U;
  const std::string message = message_of_error(ErrorKind::usage, [&] { open_source(scratch.path("a.vdb"), options); });
  EXPECT_TRUE(message.starts_with(scratch.path("a.vdb") + ": grid 'a': its tree takes 8.")) << message;
  EXPECT_NE(message.find(" MiB of memory, more than --memory 4.0 MiB leaves; give at least "), std::string::npos);
}

TEST(VdbSource, RefusesGridsWithoutActiveVoxels) {
  const Scratch scratch;
  const std::string path = scratch.path("a.vdb");
  test::write_vdb(path, {OpenVdbGrid(GridKind::float32, "a")});
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }),
            path + ": grid 'a' has no active voxel; nothing to convert");
  test::write_vdb(path, {});
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }), path + ": holds no grid");
}

TEST(VdbSource, RefusesStreamsAndGarbage) {
  const Scratch scratch;
  std::string path = scratch.path("a.vdb");
  OpenVdbGrid grid(GridKind::float32, "a");
  test::write_vdb(path, {grid.fill({{0, 0, 0}, {1, 1, 1}})}, Compression::none, true);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }),
            path +
                ": at byte 21: the file was written as a stream, without the grids' offsets; write it again as a "
                "file");
  path = write_headed(scratch, "b.vdb", "garbage");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }),
            path + ": does not begin as an OpenVDB file does");
}

TEST(VdbSource, AFileCutAtAnyByteIsRefused) {
  const Scratch scratch;
  for (const auto compression : {Compression::active_mask, Compression::zip_active_mask, Compression::blosc}) {
    OpenVdbGrid grid(GridKind::float32, "a");
    test::write_vdb(scratch.path("a.vdb"), {grid.fill({{0, 0, 0}, {5, 4, 3}})}, compression);
    const auto whole = test::read_whole(scratch.path("a.vdb"));
    // A node's masks are thousands of bytes, and all cuts in them are alike. So only cuts near the ends try every byte.
    for (std::size_t size = 1; size < whole.size(); size += size < 600 || whole.size() - size < 300 ? 1 : 211) {
      const std::string path = scratch.write("cut.vdb", std::span(whole).first(size));
      const std::string message = message_of_error(ErrorKind::input, [&] { open_source(path, {}); });
      ASSERT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

TEST(VdbSource, ADamagedByteCostsNoCrash) {
  const Scratch scratch;
  for (const auto compression : {Compression::active_mask, Compression::zip_active_mask, Compression::blosc}) {
    OpenVdbGrid grid(GridKind::float32, "a");
    test::write_vdb(scratch.path("a.vdb"), {grid.fill({{0, 0, 0}, {5, 4, 3}})}, compression);
    const auto whole = test::read_whole(scratch.path("a.vdb"));
    for (std::size_t at = 0; at < whole.size(); at += at < 600 || whole.size() - at < 600 ? 1 : 61) {
      constexpr std::array<unsigned, 3> kChanges{0x01, 0x80, 0xFF};
      auto bytes = whole;
      bytes[at] ^= static_cast<std::byte>(kChanges[at % 3]);
      const std::string path = scratch.write("bad.vdb", bytes);
      const LeaksOfLibraries of_openvdb;  // of nodes that two positions say to have
      try {
        const auto source = open_source(path, {});
        const Box domain = source->info().domain();
        std::vector<float> values(1);
        source->read({domain.lo, domain.lo + Index3{1, 1, 1}}, values);
      } catch (const Error& error) {
        ASSERT_TRUE(error.kind() == ErrorKind::input || error.kind() == ErrorKind::usage) << error.what();
        ASSERT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
      }
    }
  }
}

TEST(VdbSource, ReadsThePublishedCloud) {
  const auto path = std::filesystem::path(WEIR_SOURCE_DIR) / "../shared/data/wdas_cloud_sixteenth.vdb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: no " << path;
  const auto source = open_source(path.string(), {});
  const SourceInfo& info = source->info();
  EXPECT_EQ(info.dataset, "density");
  EXPECT_EQ(info.extent, (Index3{126, 86, 154}));
  EXPECT_EQ(info.index_origin, (Index3{-66, -21, -90}));
  const std::vector<float> values = read_volume(*source);
  EXPECT_EQ(*std::min_element(values.begin(), values.end()), 0.0F);
  EXPECT_EQ(*std::max_element(values.begin(), values.end()), 1.0F);
}

}  // namespace
}  // namespace weir::vdb_source_test
