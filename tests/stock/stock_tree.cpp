#include "tests/stock/stock_tree.h"

#include <nanovdb/util/GridStats.h>
#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>

#include <sstream>
#include <stdexcept>

#include "format/layout/nanovdb_layout.h"
#include "tests/stock/coord.h"

namespace weir::test {
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

  virtual ~Implementation() = default;
  virtual bool valid() const = 0;
  virtual std::string name() const = 0;
  virtual float value(const nanovdb::Coord& i) const = 0;
  virtual bool active(const nanovdb::Coord& i) const = 0;
  virtual nanovdb::CoordBBox index_bbox() const = 0;
  virtual std::uint64_t active_voxels() const = 0;
  virtual void set_statistics(nanovdb::GridHandle<nanovdb::HostBuffer>& of) const = 0;
};

namespace {

// Calls through a base class, because the type of the grid is known when the file is read.
template <typename Base, typename BuildT>
struct GridOf final : Base {
  const nanovdb::NanoGrid<BuildT>* grid = nullptr;

  bool valid() const override { return nanovdb::isValid(*grid, true); }
  std::string name() const override { return grid->gridName(); }
  float value(const nanovdb::Coord& i) const override { return grid->tree().getValue(i); }
  bool active(const nanovdb::Coord& i) const override { return grid->tree().isActive(i); }
  nanovdb::CoordBBox index_bbox() const override { return grid->indexBBox(); }
  std::uint64_t active_voxels() const override { return grid->activeVoxelCount(); }
  void set_statistics(nanovdb::GridHandle<nanovdb::HostBuffer>& of) const override {
    nanovdb::gridStats(*of.grid<BuildT>(), nanovdb::StatsMode::All);
  }
};

template <typename Base, typename BuildT>
bool take(nanovdb::GridHandle<nanovdb::HostBuffer>& handle, std::unique_ptr<Base>& reader) {
  if (handle.grid<BuildT>() == nullptr) return false;
  auto grid = std::make_unique<GridOf<Base, BuildT>>();
  grid->handle = std::move(handle);
  grid->grid = grid->handle.template grid<BuildT>();
  reader = std::move(grid);
  return true;
}

std::vector<std::byte> bytes_of(const nanovdb::GridHandle<nanovdb::HostBuffer>& handle) {
  const auto bytes = std::as_bytes(std::span(handle.data(), handle.size()));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

StockReader::StockReader(std::span<const std::byte> file) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(file.data()), file.size()));
  auto handle = nanovdb::io::readGrid(in);
  using I = Implementation;
  if (take<I, float>(handle, implementation_) || take<I, nanovdb::FpN>(handle, implementation_) ||
      take<I, nanovdb::Fp4>(handle, implementation_) || take<I, nanovdb::Fp8>(handle, implementation_) ||
      take<I, nanovdb::Fp16>(handle, implementation_)) {
    return;
  }
  throw std::runtime_error("the stock reader finds no grid of floats");
}

StockReader::~StockReader() = default;

bool StockReader::valid() const { return implementation_->valid(); }
std::string StockReader::name() const { return implementation_->name(); }
float StockReader::value(const Index3& i) const { return implementation_->value(coord<nanovdb::Coord>(i)); }
bool StockReader::active(const Index3& i) const { return implementation_->active(coord<nanovdb::Coord>(i)); }
Box StockReader::index_bbox() const {
  const auto box = implementation_->index_bbox();
  return {{box.min()[0], box.min()[1], box.min()[2]},
          {std::int64_t{box.max()[0]} + 1, std::int64_t{box.max()[1]} + 1, std::int64_t{box.max()[2]} + 1}};
}
std::uint64_t StockReader::active_voxels() const { return implementation_->active_voxels(); }
std::vector<std::byte> StockReader::grid() const { return bytes_of(implementation_->handle); }
std::vector<std::byte> StockReader::grid_with_stock_statistics() const {
  nanovdb::GridHandle<nanovdb::HostBuffer> copy(nanovdb::HostBuffer::create(implementation_->handle.size()));
  std::copy_n(implementation_->handle.data(), copy.size(), copy.data());
  implementation_->set_statistics(copy);
  return bytes_of(copy);
}

}  // namespace weir::test
