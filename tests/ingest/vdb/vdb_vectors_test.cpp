// Grids of vectors in OpenVDB files: their components and lengths.
#include <array>
#include <cmath>

#include "format/base/text.h"
#include "ingest/source_registry.h"
#include "ingest/vdb/vdb_source.h"
#include "tests/ingest/support/header_file.h"
#include "tests/stock/openvdb_file.h"

namespace weir::vdb_vectors_test {
namespace {

using test::Compression;
using test::GridKind;
using test::OpenVdbGrid;

SourceOptions choosing(const std::string& component) {
  SourceOptions options;
  options.component = parse_component(component);
  return options;
}

/// Compares every voxel of the domain with component 0, 1 or 2 of the vector that OpenVDB reads, or with the vector's
/// length if `component` is 3.
void expect_component(VolumeSource& source, const OpenVdbGrid& grid, std::size_t component) {
  const Box domain = grid.active();
  ASSERT_EQ(source.info().domain(), domain);
  const std::vector<float> values = read_volume(source);
  std::size_t n = 0;
  for_each_index(domain, [&](const Index3& i) {
    const auto [x, y, z] = grid.vector(i);
    const double expected = component == 3 ? std::sqrt(x * x + y * y + z * z) : std::array{x, y, z}[component];
    ASSERT_EQ(values[n++], static_cast<float>(expected)) << i.x << ' ' << i.y << ' ' << i.z;
  });
}

TEST(VdbVectors, ComponentsAndLengthsByEveryCompression) {
  const Scratch scratch;
  const std::string path = scratch.path("a.vdb");
  const std::vector<std::pair<GridKind, ScalarType>> types{{GridKind::vec3s, ScalarType::float32},
                                                           {GridKind::vec3d, ScalarType::float64},
                                                           {GridKind::vec3i, ScalarType::int32}};
  for (const auto& [kind, scalar] : types) {
    OpenVdbGrid grid(kind, "velocity");
    grid.fill({{-13, -5, -9}, {21, 12, 13}}).set_off({-12, -4, -8}, 77).tile(1, {64, 64, 64}, 3, true);
    for (const auto compression : {Compression::none, Compression::active_mask, Compression::zip_active_mask,
                                   Compression::blosc, Compression::blosc_active_mask}) {
      SCOPED_TRACE(cat(scalar_name(scalar), " by ", static_cast<int>(compression)));
      test::write_vdb(path, {grid}, compression);
      const std::array<std::string, 4> components{"x", "1", "z", "magnitude"};
      for (std::size_t c = 0; c < components.size(); ++c) {
        const auto source = open_source(path, choosing(components[c]));
        EXPECT_EQ(source->info().type, scalar);
        EXPECT_EQ(source->info().lengths, c == 3);
        EXPECT_EQ(source->info().details.component, c == 3 ? "magnitude" : cat(c));
        expect_component(*source, grid, c);
      }
    }
  }
}

TEST(VdbVectors, SavedAsHalf) {
  const Scratch scratch;
  const std::string path = scratch.path("a.vdb");
  for (const auto compression : {Compression::none, Compression::active_mask, Compression::zip_active_mask}) {
    OpenVdbGrid grid(GridKind::vec3s, "v");
    grid.fill({{-9, 0, 0}, {9, 9, 9}}).tile(1, {16, 0, 0}, -6, true).save_as_half();
    test::write_vdb(path, {grid}, compression);
    expect_component(*open_source(path, choosing("z")), grid, 2);
  }
}

TEST(VdbVectors, AskForAComponentAndAreToldFromScalars) {
  const Scratch scratch;
  const std::string path = scratch.path("a.vdb");
  OpenVdbGrid density(GridKind::float32, "density");
  OpenVdbGrid velocity(GridKind::vec3s, "velocity");
  density.fill({{0, 0, 0}, {2, 1, 1}});
  velocity.fill({{0, 0, 0}, {3, 1, 1}});
  test::write_vdb(path, {density, velocity});
  EXPECT_EQ(open_source(path, {})->info().dataset, "density");
  expect_component(*open_source(path, choosing("y")), velocity, 1);
  SourceOptions velocity_alone;
  velocity_alone.dataset = "velocity";
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, velocity_alone); }),
            path + ": grid 'velocity': has 3 components a voxel; give --component: 0 to 2, x, y, z or magnitude");
  SourceOptions scalar = choosing("0");
  scalar.dataset = "density";
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, scalar); }),
            path + ": grid 'density': has one value a voxel, and no components; leave --component out");
  EXPECT_EQ(list_vdb(path, {})[1].components, 3);
  EXPECT_EQ(list_vdb(path, {})[1].type, "float32 x 3");
}

}  // namespace
}  // namespace weir::vdb_vectors_test
