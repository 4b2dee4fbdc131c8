#include "tests/stock/stock_nvdb.h"

#include <gtest/gtest.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_directory.h"

namespace weir::test {
namespace {

constexpr float kBackground = 0.25F;

float wave(int x, int y, int z) {
  return std::sin(0.37F * static_cast<float>(x)) + 0.25F * std::cos(0.11F * static_cast<float>(y * z)) +
         0.01F * static_cast<float>(z);
}

void fill_wave(openvdb::FloatGrid::Accessor& accessor, const Box& box) {
  for (auto x = static_cast<int>(box.lo.x); x < box.hi.x; ++x) {
    for (auto y = static_cast<int>(box.lo.y); y < box.hi.y; ++y) {
      for (auto z = static_cast<int>(box.lo.z); z < box.hi.z; ++z) accessor.setValue({x, y, z}, wave(x, y, z));
    }
  }
}

openvdb::FloatGrid::Ptr sample_grid() {
  auto grid = openvdb::FloatGrid::create(kBackground);
  grid->setName("sample");
  auto transform = openvdb::math::Transform::createLinearTransform(0.5);
  transform->postTranslate({10, 20, 30});
  grid->setTransform(transform);
  auto accessor = grid->getAccessor();
  for (const Box& box : stock_sample_boxes()) fill_wave(accessor, box);
  auto& tree = grid->tree();
  tree.addTile(1, {64, 64, 64}, 3.5F, true);       // 8^3
  tree.addTile(1, {72, 64, 64}, -7.0F, false);     // 8^3, inactive
  tree.addTile(2, {256, 128, 0}, 2.0F, true);      // 128^3
  tree.addTile(2, {384, 128, 0}, 1.0F, false);     // 128^3, inactive
  tree.addTile(3, {-8192, 4096, 0}, -1.5F, true);  // 4096^3
  for (int i = 0; i < 512; ++i) accessor.setValue({96 + (i >> 6), 8 + (i >> 3 & 7), 8 + (i & 7)}, 0.75F);
  accessor.setValueOff({97, 9, 9}, 11.0F);
  return grid;
}

openvdb::FloatGrid::Ptr second_grid() {
  auto grid = openvdb::FloatGrid::create(-1.0F);
  grid->setName("second");
  grid->getAccessor().setValue({1, 2, 3}, 4.0F);
  return grid;
}

template <typename BuildT>
nanovdb::GridHandle<nanovdb::HostBuffer> convert(const openvdb::FloatGrid& grid) {
  return nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, BuildT>(grid, nanovdb::StatsMode::All,
                                                                                 nanovdb::ChecksumMode::Partial);
}

std::vector<std::byte> written(const std::function<void(const std::string&)>& write) {
  const TemporaryDirectory directory;
  write(directory / "sample.nvdb");
  return read_whole(directory / "sample.nvdb");
}

}  // namespace

struct StockNvdb::Implementation {
  nanovdb::GridHandle<nanovdb::HostBuffer> handle;
  std::function<float(const nanovdb::Coord&)> value;
  std::function<bool(const nanovdb::Coord&)> active;
  nanovdb::CoordBBox bbox;
  std::uint64_t active_voxels = 0;
  float min = 0;
  float max = 0;

  template <typename BuildT>
  void set(nanovdb::GridHandle<nanovdb::HostBuffer> from) {
    handle = std::move(from);
    const auto* grid = handle.grid<BuildT>();
    if (grid == nullptr) throw std::runtime_error("the stock converter made another type of grid");
    const auto* tree = &grid->tree();
    value = [tree](const nanovdb::Coord& i) { return tree->getValue(i); };
    active = [tree](const nanovdb::Coord& i) { return tree->isActive(i); };
    bbox = grid->indexBBox();
    active_voxels = grid->activeVoxelCount();
    min = tree->root().minimum();
    max = tree->root().maximum();
  }
};

StockNvdb::StockNvdb(GridType type) : implementation_(std::make_unique<Implementation>()) {
  const auto grid = sample_grid();
  switch (type) {
    case GridType::float32:
      implementation_->set<float>(convert<float>(*grid));
      break;
    case GridType::fp4:
      implementation_->set<nanovdb::Fp4>(convert<nanovdb::Fp4>(*grid));
      break;
    case GridType::fp8:
      implementation_->set<nanovdb::Fp8>(convert<nanovdb::Fp8>(*grid));
      break;
    case GridType::fp16:
      implementation_->set<nanovdb::Fp16>(convert<nanovdb::Fp16>(*grid));
      break;
    case GridType::fpn:
      implementation_->set<nanovdb::FpN>(convert<nanovdb::FpN>(*grid));
      break;
  }
}

StockNvdb::~StockNvdb() = default;

std::vector<std::byte> StockNvdb::file() const {
  return written([&](const std::string& path) { nanovdb::io::writeGrid(path, implementation_->handle); });
}

std::vector<std::byte> StockNvdb::file_of_two() const {
  std::vector<nanovdb::GridHandle<nanovdb::HostBuffer>> handles;
  handles.push_back(convert<float>(*sample_grid()));
  handles.push_back(convert<float>(*second_grid()));
  return written([&](const std::string& path) { nanovdb::io::writeGrids(path, handles); });
}

float StockNvdb::value(const Index3& i) const {
  return implementation_->value({static_cast<int>(i.x), static_cast<int>(i.y), static_cast<int>(i.z)});
}

bool StockNvdb::active(const Index3& i) const {
  return implementation_->active({static_cast<int>(i.x), static_cast<int>(i.y), static_cast<int>(i.z)});
}

Box StockNvdb::index_bbox() const {
  const auto& b = implementation_->bbox;
  return {{b.min()[0], b.min()[1], b.min()[2]},
          {std::int64_t{b.max()[0]} + 1, std::int64_t{b.max()[1]} + 1, std::int64_t{b.max()[2]} + 1}};
}

std::uint64_t StockNvdb::active_voxels() const { return implementation_->active_voxels; }
float StockNvdb::min() const { return implementation_->min; }
float StockNvdb::max() const { return implementation_->max; }

std::vector<Box> stock_sample_boxes() {
  return {{{-13, -5, -9}, {21, 12, 13}},
          {{120, 0, 0}, {133, 9, 9}},
          {{4090, 4000, -20}, {4103, 4007, 5}},
          {{-4100, -3, -3}, {-4093, 3, 3}}};
}

std::vector<std::byte> read_whole(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto view = std::as_bytes(std::span(bytes));
  return {view.begin(), view.end()};
}

void write_whole(const std::string& path, const std::vector<std::byte>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace weir::test
