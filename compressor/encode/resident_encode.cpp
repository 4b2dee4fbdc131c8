#include "compressor/encode/resident_encode.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "compressor/encode/coded_regions.h"
#include "compressor/encode/left_leaves.h"
#include "compressor/encode/packed_encoder.h"
#include "compressor/packed/block_values.h"
#include "compressor/survey/one_ahead.h"
#include "compressor/survey/surveyed_leaves.h"

namespace weir {
namespace {

// Collects the records of one region's leaves.
class RegionRecords final : public RecordSink {
 public:
  RegionRecords(std::uint64_t first, std::uint32_t count) : first_(first), records_(count) {}
  void write(std::uint64_t first, std::span<const LeafRecord> records) override {
    std::ranges::copy(records, records_.begin() + static_cast<std::ptrdiff_t>(first - first_));
  }
  std::span<const LeafRecord> all() const { return records_; }

 private:
  std::uint64_t first_;
  std::vector<LeafRecord> records_;
};

// Discards the records: the device has made them already.
class NoRecords final : public RecordSink {
 public:
  void write(std::uint64_t, std::span<const LeafRecord>) override {}
};

class ResidentEncode {
 public:
  ResidentEncode(ResidentVolume& resident, VolumeSource& source, const EncodeTarget& target,
                 const StreamOptions& options)
      : resident_(resident), source_(source), target_(target), options_(options), encoders_([&target] {
          return make_packed_encoder(target);
        }) {}

  void run() {
    std::vector<std::int64_t> regions;
    for (std::size_t i = 0; i < target_.tree.regions.size(); ++i) {
      if (target_.tree.regions[i].leaves > 0) regions.push_back(static_cast<std::int64_t>(i));
    }
    one_ahead<std::unique_ptr<Part>>(
        regions.size(), resident_.most_open(),
        [&](std::size_t i, std::unique_ptr<Part>& part) { part = begin(regions[i]); },
        [&](std::unique_ptr<Part>& part) {
          end(*part);
          part.reset();
        });
  }

 private:
  // A region that the device works on.
  struct Part {
    std::int64_t region;
    Box box;                                 // leaves of the region
    std::unique_ptr<ResidentBlocks> blocks;  // null: the host encodes the whole region
    std::unique_ptr<CodedBatch> batch;
    LeftLeaves left;
    std::optional<SurveyedLeaves> surveyed;
  };

  std::unique_ptr<Part> begin(std::int64_t region) {
    throw_if_cancelled(options_);
    const TraceSpan span(target_.trace, "ask");
    const Box box = target_.tree.leaf_box(region);
    auto part = std::make_unique<Part>(Part{region, box, nullptr, nullptr, LeftLeaves(box), std::nullopt});
    part->blocks = resident_.open(target_.tree.leaves.nodes_box(box));
    if (part->blocks) {
      part->batch = std::make_unique<CodedBatch>(target_, box, std::span(&part->region, 1), *part->blocks,
                                                 CodedBatch::Blocks::resident);
    }
    part->surveyed.emplace(target_.rows, box, source_.info());
    return part;
  }

  void end(Part& part) {
    take(part);
    if (target_.regions == nullptr) {
      encode(part, *target_.records);
    } else if (part.left.leaves().empty()) {  // the device has made all records
      NoRecords none;
      encode(part, none);
      finish_region(part, coded_of(part).records());
    } else {
      const Region& region = target_.tree.regions[static_cast<std::size_t>(part.region)];
      RegionRecords records(region.first_leaf, region.leaves);
      encode(part, records);
      finish_region(part, records.all());
    }
    const std::lock_guard lock(progress_);
    done_ += target_.tree.leaves.voxels(part.box).voxels();
    if (options_.progress) options_.progress(done_, target_.tree.leaves.domain.voxels());
  }

  void encode(const Part& part, RecordSink& records) {
    tbb::parallel_for(part.box.lo.x, part.box.hi.x, [&](std::int64_t x) {
      const TraceSpan span(target_.trace, "encode");
      PackedLayerEncoder& encoder = *encoders_.local();
      encoder.add_layer(part.region, places_of(part), *part.surveyed, x, coded_of(part), part.left, records);
      encoder.finish();
    });
  }

  void finish_region(const Part& part, std::span<const LeafRecord> records) {
    const TraceSpan span(target_.trace, "finish");
    target_.regions->take(part.region, records);
  }

  const RegionPlaces& places_of(const Part& part) const { return part.batch->regions().front().places; }
  const CodedRegion& coded_of(const Part& part) const { return part.batch->regions().front().coded; }

  // Waits for the streams of a region, and gets the values of the leaves that the device has left to the host.
  void take(Part& part) {
    if (part.batch) {
      part.batch->wait();
    } else {
      part.batch = std::make_unique<CodedBatch>(target_, part.box, part.region);
    }
    const StreamPlaces& places = *places_of(part).streams;
    for_each_in_file_order(part.box, [&](const Index3& leaf) {
      if (places.kept(target_.tree.mask_position(leaf)) && !coded_of(part).find(leaf)) part.left.add(leaf);
    });
    const std::vector<Index3>& left = part.left.leaves();
    if (left.empty()) return;
    part.left.values().resize(kLeafVoxels * left.size());
    if (part.blocks) {
      std::vector<std::uint32_t> numbers;
      for (const Index3& leaf : left) {
        numbers.push_back(static_cast<std::uint32_t>(linear_index(leaf - part.box.lo, part.box.extent())));
      }
      if (const auto values = part.blocks->values(numbers)) {
        std::copy(values->begin(), values->end(), part.left.values().begin());
        return;
      }
    }
    read_blocks(source_, target_.tree.leaves, part.box, left, part.left.values());
  }

  ResidentVolume& resident_;
  VolumeSource& source_;
  const EncodeTarget& target_;
  const StreamOptions& options_;
  tbb::enumerable_thread_specific<std::unique_ptr<PackedLayerEncoder>> encoders_;
  std::mutex progress_;
  std::int64_t done_ = 0;
};

}  // namespace

void encode_resident(ResidentVolume& resident, VolumeSource& source, const EncodeTarget& target,
                     const StreamOptions& options) {
  ResidentEncode(resident, source, target, options).run();
}

}  // namespace weir
