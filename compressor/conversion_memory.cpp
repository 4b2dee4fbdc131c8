#include "compressor/conversion_memory.h"

#include <algorithm>
#include <vector>

#include "compressor/encode/leaf_record.h"
#include "compressor/packed/packed_ladder.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/select/packed_region.h"
#include "compressor/select/region_rows.h"
#include "compressor/survey/leaf_cache.h"
#include "compressor/survey/leaf_faces.h"
#include "format/base/error.h"

namespace weir {
namespace {

// Returns the most bytes for cached values: three quarters of the memory that is left beside a conversion at full
// speed.
std::uint64_t bytes_to_cache(std::uint64_t ceiling, std::uint64_t resident, const Box& domain) {
  constexpr std::uint64_t kLeastEnough = std::uint64_t{64} << 20U;
  constexpr std::uint64_t kEnough = std::uint64_t{512} << 20U;
  const std::uint64_t dense = float32_bytes(domain);
  const std::uint64_t needed = resident + std::clamp(dense / 2, kLeastEnough, kEnough);
  const NodeLattice leaves = make_lattice(domain, kLeafDim);
  return std::min(LeafCache::whole_bytes(leaves), ceiling > needed ? (ceiling - needed) / 4 * 3 : 0);
}

// Returns whether the survey may cache the values that it reads. It may not for a sample, for a source that already
// lies in memory or on a device, or for coarse cells, because a coarse cell's value is read once for many voxels.
bool may_cache(VolumeSource& source, const ReadingPlan& reading) {
  if (reading.reading != Reading::ahead || source.resident() != nullptr || source.places() != nullptr) return false;
  const BlockPlan& plan = reading.survey;
  for (const std::int64_t block : {std::int64_t{0}, plan.size() / 2, plan.size() - 1}) {
    const std::vector<RepeatedPart> parts = source.repeated_parts(plan.voxel_box(plan.leaf_box(block)));
    if (std::any_of(parts.begin(), parts.end(), [](const RepeatedPart& part) { return part.repeats(); })) return false;
  }
  return true;
}

// Returns whether `keeping`, a plan that caches values, decodes chunks no more often than `shares`, which does not,
// and holds at least as many bytes of records.
bool takes_nothing_away(const MemoryShares& keeping, const MemoryShares& shares) {
  return keeping.reading.encode.amplification <= shares.reading.encode.amplification &&
         keeping.memory.record_bytes >= shares.memory.record_bytes;
}

}  // namespace

std::uint64_t record_bytes(const ConversionOptions& options, const Box& domain) {
  std::uint64_t of_leaf = sizeof(LeafRow) + sizeof(LeafRecord);
  std::uint64_t of_region = 2 * sizeof(LeafChoices);  // selection chooses between two plans
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

Workers choose_workers(VolumeSource& source, const ConversionOptions& options, const BlockCoder* coder,
                       std::uint64_t held) {
  const std::size_t processors = processors_or_all(options.processors);
  const std::uint64_t resident = held + source.working_bytes() + (coder == nullptr ? 0 : coder->host_bytes());
  return {processors,
          choose_threads(options.threads, processors, options.memory, resident, source.info().domain(),
                         region_bytes(options)),
          resident};
}

void check_memory(const ConversionOptions& options, const Box& domain, std::uint64_t resident) {
  const std::uint64_t region = region_bytes(options);
  const std::size_t threads =
      choose_threads(options.threads, processors_or_all(options.processors), options.memory, resident, domain, region);
  plan_memory(options.memory, resident, threads, domain, region);
}

MemoryShares share_memory(VolumeSource& source, const ConversionOptions& options, std::uint64_t resident,
                          std::size_t threads, bool may_hold) {
  const Box domain = source.info().domain();
  const auto shares_with = [&](std::uint64_t kept, bool hold) {
    const std::uint64_t records = hold ? record_bytes(options, domain) : 0;
    const MemoryPlan memory =
        plan_memory(options.memory - kept, resident, threads, domain, region_bytes(options), records);
    return MemoryShares{memory, plan_reading(source, memory), kept};
  };
  const auto plan = [&](std::uint64_t kept) {
    MemoryShares shares = shares_with(kept, may_hold);
    if (shares.memory.record_bytes > 0 && shares.reading.encode.amplification > 1) shares = shares_with(kept, false);
    return shares;
  };
  MemoryShares shares = plan(0);
  if (!may_cache(source, shares.reading)) return shares;
  const std::uint64_t most = bytes_to_cache(options.memory, resident, domain);
  const std::uint64_t least = 2 * LeafCache::index_bytes(make_lattice(domain, kLeafDim));
  for (std::uint64_t kept = most; kept > least; kept /= 2) {
    try {
      MemoryShares keeping = plan(kept);
      if (takes_nothing_away(keeping, shares)) return keeping;
    } catch (const Error& too_little) {
      if (too_little.kind() != ErrorKind::usage) throw;
    }
  }
  return shares;
}

}  // namespace weir
