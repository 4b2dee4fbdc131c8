#include "compressor/conversion_memory.h"

#include "compressor/encode/leaf_record.h"
#include "compressor/packed/packed_ladder.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/select/packed_region.h"
#include "compressor/select/region_rows.h"
#include "compressor/survey/leaf_faces.h"

namespace weir {

std::uint64_t record_bytes(const ConversionOptions& options, const Box& domain) {
  std::uint64_t of_leaf = sizeof(LeafRow) + sizeof(LeafRecord);
  std::uint64_t of_region = 2 * sizeof(LeafChoices);  // of two plans, between which is chosen
  if (options.encoding == Encoding::packed) {
    of_leaf += sizeof(PackedLadder);
    of_region += 2 * sizeof(PlannedStreams);
  }
  if (options.scene) of_leaf += sizeof(LeafFaces) + sizeof(MinMax);
  const auto leaves = static_cast<std::uint64_t>(make_lattice(domain, kLeafDim).size());
  const auto regions = static_cast<std::uint64_t>(make_lattice(domain, kLowerDim).size());
  return leaves * of_leaf + regions * of_region;
}

std::uint64_t region_bytes(const ConversionOptions& options) {
  if (options.encoding != Encoding::packed) return kRegionRowsBytes;
  // A block has many more steps than a leaf; sorted, there are two copies of them.
  return kRegionRowsBytes + kRegionLaddersBytes + 2 * RegionGains::kMostBytes;
}

MemoryShares share_memory(const VolumeSource& source, const ConversionOptions& options, std::uint64_t resident,
                          std::size_t threads, bool may_hold) {
  const Box domain = source.info().domain();
  const auto shares_with = [&](std::uint64_t records) {
    const MemoryPlan memory = plan_memory(options.memory, resident, threads, domain, region_bytes(options), records);
    return MemoryShares{memory, plan_reading(source, memory)};
  };
  MemoryShares shares = shares_with(may_hold ? record_bytes(options, domain) : 0);
  if (shares.memory.record_bytes > 0 && shares.reading.encode.amplification > 1) shares = shares_with(0);
  return shares;
}

}  // namespace weir
