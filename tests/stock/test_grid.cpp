#include "tests/stock/test_grid.h"

#include <gtest/gtest.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "format/base/text.h"
#include "tests/stock/coord.h"

namespace weir::test {

namespace {

template <typename BuildT>
std::vector<std::byte> converted(const openvdb::FloatGrid& grid) {
  const auto handle = nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, BuildT>(
      grid, nanovdb::StatsMode::All, nanovdb::ChecksumMode::Partial);
  const std::string path = cat(testing::TempDir(), "weir_test_grid_", ::getpid(), ".nvdb");
  nanovdb::io::writeGrid(path, handle, nanovdb::io::Codec::NONE);
  std::vector<std::byte> file(std::filesystem::file_size(path));
  std::ifstream(path, std::ios::binary)
      .read(reinterpret_cast<char*>(file.data()), static_cast<std::streamsize>(file.size()));
  std::filesystem::remove(path);
  return file;
}

std::vector<std::byte> written(GridType type, const openvdb::FloatGrid& grid) {
  switch (type) {
    case GridType::float32:
      return converted<float>(grid);
    case GridType::fp4:
      return converted<nanovdb::Fp4>(grid);
    case GridType::fp8:
      return converted<nanovdb::Fp8>(grid);
    case GridType::fp16:
      return converted<nanovdb::Fp16>(grid);
    case GridType::fpn:
      return converted<nanovdb::FpN>(grid);
  }
  throw std::logic_error("no such grid type");
}

}  // namespace

TestGrid::TestGrid(const Box& box, const Value& value, const TestGridOptions& options) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(options.background);
  grid->setName("test");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
  grid->transform().postScale({options.voxel_size[0], options.voxel_size[1], options.voxel_size[2]});
  auto accessor = grid->getAccessor();
  for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t x = box.lo.x; x < box.hi.x; ++x)
        accessor.setValue(coord<openvdb::Coord>({x, y, z}), value({x, y, z}));
    }
  }
  for (const TestTile& tile : options.tiles) {
    const openvdb::Index level = tile.dim == 8 ? 1 : (tile.dim == 128 ? 2 : 3);
    grid->tree().addTile(level, coord<openvdb::Coord>(tile.origin), tile.value, tile.active);
  }
  file_ = written(options.type, *grid);
  grid_ = std::make_unique<NvdbGrid>(NvdbGrid::open(file_, "test.nvdb"));
}

}  // namespace weir::test
