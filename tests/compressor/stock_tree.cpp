#include "tests/compressor/stock_tree.h"

#include <iostream>  // GridValidator.h of 10.0.1 uses it without saying so

#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>

#include <sstream>
#include <stdexcept>

#include "format/nanovdb_layout.h"

namespace weir::test {
namespace {

template <typename Coord>
Coord coord(const Index3& i) {
  return Coord(static_cast<int>(i.x), static_cast<int>(i.y), static_cast<int>(i.z));
}

}  // namespace

struct StockTree::Implementation {
  openvdb::FloatGrid::Ptr grid;
};

StockTree::StockTree(float background) : implementation_(std::make_unique<Implementation>()) {
  implementation_->grid = openvdb::FloatGrid::create(background);
}

StockTree::~StockTree() = default;
StockTree::StockTree(StockTree&&) noexcept = default;

void StockTree::add_leaf(const Index3& origin, std::span<const float, 512> values, const std::bitset<512>& active) {
  auto* leaf = implementation_->grid->tree().touchLeaf(coord<openvdb::Coord>(origin));
  for (openvdb::Index i = 0; i < 512; ++i) {
    leaf->setValueOnly(i, values[i]);
    leaf->setActiveState(i, active[i]);
  }
}

void StockTree::add_tile(const Index3& origin, std::int64_t dim, float value, bool active) {
  const openvdb::Index level = dim == kLeafDim ? 1 : dim == kLowerDim ? 2 : 3;
  implementation_->grid->tree().addTile(level, coord<openvdb::Coord>(origin), value, active);
}

std::vector<std::byte> StockTree::file(const std::string& name, const std::array<double, 3>& spacing,
                                       const std::array<double, 3>& origin) const {
  auto& grid = *implementation_->grid;
  grid.setName(name);
  // Step by step: a transform made from a map goes through OpenVDB's simplify(), which rounds the scale.
  auto transform = openvdb::math::Transform::createLinearTransform();
  transform->postScale(openvdb::Vec3d(spacing[0], spacing[1], spacing[2]));
  transform->postTranslate(openvdb::Vec3d(origin[0], origin[1], origin[2]));
  grid.setTransform(transform);
  auto handle = nanovdb::openToNanoVDB(grid, nanovdb::StatsMode::All, nanovdb::ChecksumMode::Partial);
  // writeGrid seeks over the header first, which a string must hold for that.
  std::ostringstream out(std::string(nvdb::kNameOffset + name.size() + 1, '\0'));
  nanovdb::io::writeGrid(out, handle, nanovdb::io::Codec::NONE);
  const std::string text = out.str();
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

struct StockReader::Implementation {
  nanovdb::GridHandle<nanovdb::HostBuffer> handle;
  const nanovdb::FloatGrid* grid = nullptr;
};

StockReader::StockReader(std::span<const std::byte> file) : implementation_(std::make_unique<Implementation>()) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(file.data()), file.size()));
  implementation_->handle = nanovdb::io::readGrid(in);
  implementation_->grid = implementation_->handle.grid<float>();
  if (implementation_->grid == nullptr) throw std::runtime_error("the stock reader finds no float grid");
}

StockReader::~StockReader() = default;

bool StockReader::valid() const { return nanovdb::isValid(*implementation_->grid, true); }
std::string StockReader::name() const { return implementation_->grid->gridName(); }
float StockReader::value(const Index3& i) const {
  return implementation_->grid->tree().getValue(coord<nanovdb::Coord>(i));
}
bool StockReader::active(const Index3& i) const {
  return implementation_->grid->tree().isActive(coord<nanovdb::Coord>(i));
}
Box StockReader::index_bbox() const {
  const auto& box = implementation_->grid->indexBBox();
  return {{box.min()[0], box.min()[1], box.min()[2]},
          {std::int64_t{box.max()[0]} + 1, std::int64_t{box.max()[1]} + 1, std::int64_t{box.max()[2]} + 1}};
}
std::uint64_t StockReader::active_voxels() const { return implementation_->grid->activeVoxelCount(); }

}  // namespace weir::test
