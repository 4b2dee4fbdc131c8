#include "tools/verify/packed_report.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::array kReportedKinds{PackedKind::mean, PackedKind::transform, PackedKind::lattice, PackedKind::raw};

double two_decimals(double bits) { return std::round(100 * bits) / 100; }

}  // namespace

std::string packed_text(const PackedData& packed, const PackedCensus& census) {
  std::string kinds;
  for (const PackedKind kind : kReportedKinds) {
    const std::uint64_t blocks = census.blocks[static_cast<std::size_t>(kind)];
    kinds += cat(blocks, ' ', packed_kind_name(kind));
    if (blocks != 0) kinds += cat(" (", two_decimals(census.bits_a_voxel(kind)), " bits a voxel)");
    kinds += ", ";
  }
  return cat("packed      ", packed_block_count(packed), " blocks of 8^3: ", kinds, census.none, " none; ",
             format_bytes(packed.bytes().size()), ", of which directories and tables ",
             format_bytes(census.directory_bytes), '\n',
             packed.header().preview
                 ? "            Other readers of NanoVDB files see the mean of each block of 8^3.\n"
                 : "            Other readers of NanoVDB files see next to nothing: the file has no preview.\n");
}

nlohmann::ordered_json packed_json(const PackedData& packed, const PackedCensus& census) {
  nlohmann::ordered_json blocks;
  nlohmann::ordered_json bits;
  for (const PackedKind kind : kReportedKinds) {
    blocks[packed_kind_name(kind)] = census.blocks[static_cast<std::size_t>(kind)];
    bits[packed_kind_name(kind)] = census.bits_a_voxel(kind);
  }
  blocks["none"] = census.none;
  return {{"bytes", packed.bytes().size()},
          {"directory_bytes", census.directory_bytes},
          {"preview", packed.header().preview},
          {"blocks", blocks},
          {"bits_a_voxel", bits}};
}

}  // namespace weir
