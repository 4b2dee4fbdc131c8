// libFuzzer target for .vdb files up to where OpenVDB reads on: any bytes parse to grids and trees, or throw
// Error(input) of one line.
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "format/base/error.h"
#include "ingest/vdb/vdb_topology.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  in.exceptions(std::ios_base::badbit | std::ios_base::failbit | std::ios_base::eofbit);
  const std::string path = "fuzz.vdb";
  weir::VdbReader reader(in, size, path);
  try {
    for (const weir::VdbHeader header = weir::read_vdb_header(reader); const weir::VdbGrid& grid : header.grids) {
      const weir::VdbType* const type = weir::vdb_type(grid.tree);
      if (type == nullptr) continue;
      const weir::VdbTopology topology = weir::walk_vdb_tree(reader, grid, *type);
      // Each leaf has two masks of 64 bytes, each other node two of at least 512.
      if (topology.nodes[0] * 128 + topology.nodes[1] * 1024 + topology.nodes[2] * 8192 > size) std::abort();
    }
  } catch (const weir::Error& error) {
    const std::string_view message = error.what();
    if (error.kind() != weir::ErrorKind::input || message.find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
