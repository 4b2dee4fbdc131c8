// The entry point of weir_openvdb.so, and all code that is compiled against OpenVDB.
#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <cstring>
#include <exception>
#include <new>
#include <type_traits>

#include "format/base/error.h"
#include "ingest/drivers/driver.h"
#include "ingest/headers/header_text.h"
#include "ingest/vdb/openvdb_library.h"

namespace weir {
namespace {

template <typename Tree>
class Leaves final : public LeafReader {
 public:
  explicit Leaves(const Tree& tree) : accessor_(tree) {}

  void read(const Index3& origin, std::span<std::byte> values) override {
    const openvdb::Coord at(static_cast<int>(origin.x), static_cast<int>(origin.y), static_cast<int>(origin.z));
    using Value = typename Tree::ValueType;
    const auto* const leaf = accessor_.probeConstLeaf(at);
    if (leaf == nullptr) {
      const Value tile = accessor_.getValue(at);
      for (std::size_t i = 0; i < values.size(); i += sizeof tile) std::memcpy(&values[i], &tile, sizeof tile);
    } else if constexpr (std::is_same_v<Value, bool>) {
      for (openvdb::Index i = 0; i < values.size(); ++i) values[i] = std::byte{leaf->getValue(i)};
    } else {
      std::memcpy(values.data(), leaf->buffer().data(), values.size());
    }
  }

 private:
  openvdb::tree::ValueAccessor<const Tree, false> accessor_;  // false: not registered, for the tree does not change
};

// Makes and fills the tree through OpenVDB's registry and virtual functions. To construct the tree here would compile
// its whole class again, ten seconds for each class.
template <typename Tree>
class LoadedTree final : public LeafTree {
 public:
  LoadedTree(std::istream& in, const std::string& type, bool as_half) : grid_(openvdb::GridBase::createGrid(type)) {
    const std::streamoff begin = in.tellg();
    openvdb::TreeBase& tree = grid_->baseTree();
    tree.readTopology(in, as_half);
    tree.readBuffers(in, as_half);
    bytes_read_ = static_cast<std::uint64_t>(in.tellg() - begin);
  }

  std::unique_ptr<LeafReader> reader() const override {
    return std::make_unique<Leaves<Tree>>(static_cast<const Tree&>(grid_->constBaseTree()));
  }
  bool in_memory() const override { return true; }
  std::uint64_t working_bytes() const override { return 0; }  // what it holds is resident already
  std::uint64_t bytes_read() const override { return bytes_read_; }

 private:
  openvdb::GridBase::Ptr grid_;
  std::uint64_t bytes_read_ = 0;
};

/// Calls `use` with a null pointer to the tree class of `type`.
template <typename Use>
auto with_tree(const VdbType& type, const Use& use) {
  if (type.components > 1) {
    if (type.scalar == ScalarType::float32) return use(static_cast<openvdb::Vec3STree*>(nullptr));
    if (type.scalar == ScalarType::float64) return use(static_cast<openvdb::Vec3DTree*>(nullptr));
    return use(static_cast<openvdb::Vec3ITree*>(nullptr));
  }
  switch (type.scalar) {
    case ScalarType::float32:
      return use(static_cast<openvdb::FloatTree*>(nullptr));
    case ScalarType::float64:
      return use(static_cast<openvdb::DoubleTree*>(nullptr));
    case ScalarType::int32:
      return use(static_cast<openvdb::Int32Tree*>(nullptr));
    case ScalarType::int64:
      return use(static_cast<openvdb::Int64Tree*>(nullptr));
    default:
      return type.leaf == VdbLeaf::boolean ? use(static_cast<openvdb::BoolTree*>(nullptr))
                                           : use(static_cast<openvdb::MaskTree*>(nullptr));
  }
}

std::uint64_t tree_bytes_of(const VdbType& type, const VdbTopology& topology) {
  return with_tree(type, [&](auto* of_type) -> std::uint64_t {
    using Tree = std::remove_pointer_t<decltype(of_type)>;
    using Upper = typename Tree::RootNodeType::ChildNodeType;
    using Lower = typename Upper::ChildNodeType;
    constexpr std::uint64_t kAllocation = 16;  // what malloc adds to one
    constexpr std::uint64_t kRootEntry = 160;  // a node of std::map and what it holds
    const std::uint64_t values = type.leaf == VdbLeaf::values ? kLeafVoxels * type.bytes + kAllocation : 0;
    return topology.nodes[0] * (sizeof(typename Tree::LeafNodeType) + kAllocation + values) +
           topology.nodes[1] * (sizeof(Lower) + kAllocation) + topology.nodes[2] * (sizeof(Upper) + kAllocation) +
           topology.root_entries * kRootEntry;
  });
}

std::unique_ptr<LeafTree> load_tree_of(std::istream& in, const VdbHeader& header, const VdbGrid& grid,
                                       const VdbType& type, const std::string& where) {
  try {
    openvdb::initialize();  // fills the registry, once
    openvdb::io::setVersion(in, openvdb::VersionId(header.library_major, header.library_minor), header.version);
    openvdb::io::setDataCompression(in, grid.compression);
    in.seekg(static_cast<std::streamoff>(grid.tree_offset));
    return with_tree(type, [&](auto* of_type) -> std::unique_ptr<LeafTree> {
      using Tree = std::remove_pointer_t<decltype(of_type)>;
      return std::make_unique<LoadedTree<Tree>>(in, std::string(type.tree), grid.half);
    });
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::input, cat(where, ": OpenVDB cannot read it, ", in_quotes(error.what())));
  }
}

class Library final : public OpenVdbLibrary {
 public:
  std::uint64_t tree_bytes(const VdbType& type, const VdbTopology& topology) const override {
    return tree_bytes_of(type, topology);
  }
  std::unique_ptr<LeafTree> load_tree(std::istream& in, const VdbHeader& header, const VdbGrid& grid,
                                      const VdbType& type, const std::string& where) const override {
    return load_tree_of(in, header, grid, type, where);
  }
  void write_blosc(std::ostream& out, const char* values, std::size_t value_bytes, std::size_t count) const override {
    openvdb::io::bloscToStream(out, values, value_bytes, count);
  }
  void write_zip(std::ostream& out, const char* values, std::size_t bytes) const override {
    openvdb::io::zipToStream(out, values, bytes);
  }
  std::uint16_t half_of(float value) const override { return ToHalf::convert(value).bits(); }
  float value_of_half(std::uint16_t half) const override {
    ToHalf::HalfT value;
    value.setBits(half);
    return static_cast<float>(value);
  }

 private:
  using ToHalf = openvdb::io::RealToHalf<float>;
};

}  // namespace
}  // namespace weir

WEIR_DRIVER_ENTRY;
WEIR_DRIVER_ENTRY {
  static const weir::Library library;
  return static_cast<const weir::OpenVdbLibrary*>(&library);
}
