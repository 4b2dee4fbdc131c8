// The calls that weir makes to the OpenVDB library. Only weir_openvdb.so includes OpenVDB.
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <ostream>
#include <string>

#include "ingest/vdb/leaf_source.h"
#include "ingest/vdb/vdb_header.h"
#include "ingest/vdb/vdb_topology.h"
#include "ingest/vdb/vdb_type.h"

namespace weir {

class OpenVdbLibrary {
 public:
  /// Returns the bytes of memory that a tree of these nodes takes, with the allocator's overhead.
  virtual std::uint64_t tree_bytes(const VdbType& type, const VdbTopology& topology) const = 0;

  /// Builds the tree of `grid`, which walk_vdb_tree() has checked, from `in`, which throws at its end. Throws
  /// Error(input), beginning with `where`, if OpenVDB refuses the data: compressed values that do not unpack.
  virtual std::unique_ptr<LeafTree> load_tree(std::istream& in, const VdbHeader& header, const VdbGrid& grid,
                                              const VdbType& type, const std::string& where) const = 0;

  /// Write values as OpenVDB's files hold them: write_blosc() `count` values of `value_bytes` each, compressed by
  /// Blosc; write_zip() `bytes` bytes, compressed by zlib.
  virtual void write_blosc(std::ostream& out, const char* values, std::size_t value_bytes, std::size_t count) const = 0;
  virtual void write_zip(std::ostream& out, const char* values, std::size_t bytes) const = 0;

  /// Convert to 16-bit floats, rounded to nearest, and back.
  virtual std::uint16_t half_of(float value) const = 0;
  virtual float value_of_half(std::uint16_t half) const = 0;

 protected:
  ~OpenVdbLibrary() = default;
};

/// Returns the library. Throws Error(io), beginning with `what`, if weir_openvdb.so is missing
/// (ingest/drivers/driver.h).
const OpenVdbLibrary& openvdb_library(const std::string& what);

}  // namespace weir
