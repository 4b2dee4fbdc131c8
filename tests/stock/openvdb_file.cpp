#include "tests/stock/openvdb_file.h"

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <type_traits>

#include "tests/stock/coord.h"

namespace weir::test {
namespace {

template <typename Value>
Value convert(double value) {
  if constexpr (std::is_same_v<Value, bool>) {
    return std::fmod(std::floor(value), 2.0) == 0;
  } else if constexpr (openvdb::VecTraits<Value>::IsVec) {
    using Number = typename Value::value_type;
    return Value(static_cast<Number>(value), static_cast<Number>(value + 1), static_cast<Number>(-2 * value));
  } else {
    return static_cast<Value>(value);
  }
}

template <typename Value>
std::array<double, 3> numbers(const Value& value) {
  if constexpr (openvdb::VecTraits<Value>::IsVec) {
    return {static_cast<double>(value[0]), static_cast<double>(value[1]), static_cast<double>(value[2])};
  } else {
    return {static_cast<double>(value), 0, 0};
  }
}

}  // namespace

struct OpenVdbGrid::Implementation {
  openvdb::GridBase::Ptr grid;
  std::function<void(const openvdb::Coord&, double)> set_on;
  std::function<void(const openvdb::Coord&, double)> set_off;
  std::function<void(openvdb::Index, const openvdb::Coord&, double, bool)> tile;
  std::function<std::array<double, 3>(const openvdb::Coord&)> vector;

  template <typename Grid>
  void use() {
    using Value = typename Grid::ValueType;
    // From OpenVDB's registry: a grid made here would compile all of its class again.
    grid = openvdb::GridBase::createGrid(Grid::gridType());
    auto& tree = static_cast<typename Grid::TreeType&>(grid->baseTree());
    tree.root().setBackground(convert<Value>(2), false);
    set_on = [&tree](const openvdb::Coord& at, double v) {
      if constexpr (std::is_same_v<Grid, openvdb::MaskGrid>) {
        if (convert<bool>(v)) tree.setValueOn(at);
      } else {
        tree.setValueOn(at, convert<Value>(v));
      }
    };
    set_off = [&tree](const openvdb::Coord& at, double v) { tree.setValueOff(at, convert<Value>(v)); };
    tile = [&tree](openvdb::Index level, const openvdb::Coord& at, double v, bool active) {
      tree.addTile(level, at, convert<Value>(v), active);
    };
    vector = [&tree](const openvdb::Coord& at) { return numbers(tree.getValue(at)); };
  }
};

OpenVdbGrid::OpenVdbGrid(GridKind kind, const std::string& name) : implementation_(std::make_shared<Implementation>()) {
  openvdb::initialize();
  switch (kind) {
    case GridKind::float32:
      implementation_->use<openvdb::FloatGrid>();
      break;
    case GridKind::float64:
      implementation_->use<openvdb::DoubleGrid>();
      break;
    case GridKind::int32:
      implementation_->use<openvdb::Int32Grid>();
      break;
    case GridKind::int64:
      implementation_->use<openvdb::Int64Grid>();
      break;
    case GridKind::boolean:
      implementation_->use<openvdb::BoolGrid>();
      break;
    case GridKind::mask:
      implementation_->use<openvdb::MaskGrid>();
      break;
    case GridKind::vec3s:
      implementation_->use<openvdb::Vec3SGrid>();
      break;
    case GridKind::vec3d:
      implementation_->use<openvdb::Vec3DGrid>();
      break;
    case GridKind::vec3i:
      implementation_->use<openvdb::Vec3IGrid>();
      break;
    case GridKind::points:
      implementation_->grid = openvdb::GridBase::createGrid("Tree_ptdataidx32_5_4_3");
      break;
  }
  implementation_->grid->setName(name);
}

OpenVdbGrid& OpenVdbGrid::fill(const Box& box, double scale) {
  for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
        implementation_->set_on(coord<openvdb::Coord>({x, y, z}),
                                scale * (static_cast<double>(x + 3 * y - 7 * z) + 0.125));
      }
    }
  }
  return *this;
}

OpenVdbGrid& OpenVdbGrid::set_on(const Index3& i, double value) {
  implementation_->set_on(coord<openvdb::Coord>(i), value);
  return *this;
}

OpenVdbGrid& OpenVdbGrid::set_off(const Index3& i, double value) {
  implementation_->set_off(coord<openvdb::Coord>(i), value);
  return *this;
}

OpenVdbGrid& OpenVdbGrid::tile(unsigned level, const Index3& origin, double value, bool active) {
  implementation_->tile(level, coord<openvdb::Coord>(origin), value, active);
  return *this;
}

OpenVdbGrid& OpenVdbGrid::save_as_half() {
  implementation_->grid->setSaveFloatAsHalf(true);
  return *this;
}

OpenVdbGrid& OpenVdbGrid::class_is(const std::string& name) {
  implementation_->grid->setGridClass(openvdb::GridBase::stringToGridClass(name));
  return *this;
}

OpenVdbGrid& OpenVdbGrid::place(const std::array<double, 3>& scale, const std::array<double, 3>& translate) {
  using namespace openvdb::math;
  const Vec3d s(scale[0], scale[1], scale[2]);
  const Vec3d t(translate[0], translate[1], translate[2]);
  implementation_->grid->setTransform(std::make_shared<Transform>(std::make_shared<ScaleTranslateMap>(s, t)));
  return *this;
}

OpenVdbGrid& OpenVdbGrid::rotate(double radians) {
  implementation_->grid->transform().postRotate(radians, openvdb::math::Z_AXIS);
  return *this;
}

OpenVdbGrid& OpenVdbGrid::frustum() {
  const openvdb::BBoxd box(openvdb::Vec3d(0), openvdb::Vec3d(10));
  implementation_->grid->setTransform(openvdb::math::Transform::createFrustumTransform(box, 0.5, 10));
  return *this;
}

OpenVdbGrid OpenVdbGrid::instance(const std::string& name) const {
  OpenVdbGrid copy;
  copy.implementation_ = std::make_shared<Implementation>(*implementation_);
  copy.implementation_->grid = implementation_->grid->copyGrid();  // shares the tree
  copy.implementation_->grid->setName(name);
  return copy;
}

double OpenVdbGrid::value(const Index3& i) const { return vector(i)[0]; }

std::array<double, 3> OpenVdbGrid::vector(const Index3& i) const {
  return implementation_->vector(coord<openvdb::Coord>(i));
}

Box OpenVdbGrid::active() const {
  const openvdb::CoordBBox b = implementation_->grid->evalActiveVoxelBoundingBox();
  const auto index = [](const openvdb::Coord& c) { return Index3{c.x(), c.y(), c.z()}; };
  return {index(b.min()), index(b.max()) + Index3{1, 1, 1}};
}

std::uint64_t OpenVdbGrid::memory_bytes() const { return implementation_->grid->memUsage(); }

void write_vdb(const std::string& path, const std::vector<OpenVdbGrid>& grids, Compression compression,
               bool as_stream) {
  using namespace openvdb::io;
  const auto flags = [&]() -> std::uint32_t {
    switch (compression) {
      case Compression::none:
        return COMPRESS_NONE;
      case Compression::active_mask:
        return COMPRESS_ACTIVE_MASK;
      case Compression::zip:
        return COMPRESS_ZIP;
      case Compression::zip_active_mask:
        return COMPRESS_ZIP | COMPRESS_ACTIVE_MASK;
      case Compression::blosc:
        return COMPRESS_BLOSC;
      case Compression::blosc_active_mask:
        return COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK;
    }
    throw std::logic_error("unknown compression");
  }();
  openvdb::GridCPtrVec written;
  for (const OpenVdbGrid& grid : grids) written.push_back(grid.implementation().grid);
  if (as_stream) {
    std::ofstream out(path, std::ios::binary);
    Stream stream(out);
    stream.setCompression(flags);
    stream.write(written);
    return;
  }
  File file(path);
  file.setCompression(flags);
  file.write(written);
  file.close();
}

void write_nvdb(const std::string& path, const OpenVdbGrid& grid) {
  const auto typed = openvdb::gridPtrCast<openvdb::FloatGrid>(grid.implementation().grid);
  nanovdb::io::writeGrid(path, nanovdb::openToNanoVDB(*typed));
}

}  // namespace weir::test
