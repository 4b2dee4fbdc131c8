#include "ingest/chunks/chunk_boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/extent.h"
#include "ingest/values/decode_component.h"

namespace weir {
namespace {

/// Calls visit(first voxel of the run in `part`, voxels) for the longest runs of `part` that are contiguous
/// both in a chunk of `chunk` voxels and in `box`.
template <typename Visit>
void for_each_run(const Box& part, const Index3& chunk, const Box& box, const Visit& visit) {
  const Index3 e = part.extent();
  const std::int64_t rows = e.x == chunk.x && e.x == box.extent().x ? e.y : 1;
  for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
    for (std::int64_t y = part.lo.y; y < part.hi.y; y += rows) visit(Index3{part.lo.x, y, z}, e.x * rows);
  }
}

}  // namespace

ChunkBoxes::ChunkBoxes(ChunkedVolume volume, StoredChunks& chunks, ScratchPool& scratch)
    : volume_(std::move(volume)), chunks_(chunks), scratch_(scratch) {
  std::vector<std::byte> fill;  // stored bytes of one voxel
  for (std::int64_t c = 0; c < volume_.components.count; ++c) {
    fill.insert(fill.end(), volume_.fill.begin(), volume_.fill.end());
  }
  fill_loss_ =
      decode_component(fill, volume_.type, volume_.big_endian, volume_.mapping, volume_.components, {&fill_, 1});
}

ConversionLoss ChunkBoxes::read_chunk(const Index3& chunk, const Box& box, std::span<float> values,
                                      ChunkScratch& scratch) {
  const Index3& c = volume_.chunk;
  const Index3 lo{chunk.x * c.x, chunk.y * c.y, chunk.z * c.z};
  const Box part = intersect({lo, lo + c}, box);
  const std::span<const std::byte> bytes = chunks_.decode(chunk, scratch);
  const std::size_t voxel_bytes = volume_.voxel_bytes();
  ConversionLoss loss;
  for_each_run(part, c, box, [&](const Index3& first, std::int64_t voxels) {
    const auto count = static_cast<std::size_t>(voxels);
    const auto run = values.subspan(static_cast<std::size_t>(linear_index(first - box.lo, box.extent())), count);
    if (bytes.empty()) {
      std::ranges::fill(run, fill_);
      loss.add(fill_loss_.times(count));
      return;
    }
    const std::size_t at = static_cast<std::size_t>(linear_index(first - lo, c)) * voxel_bytes;
    loss.add(decode_component(bytes.subspan(at, count * voxel_bytes), volume_.type, volume_.big_endian, volume_.mapping,
                              volume_.components, run));
  });
  return loss;
}

ConversionLoss ChunkBoxes::read(const Box& box, std::span<float> values) {
  const Box all{{0, 0, 0}, volume_.extent};
  if (box.empty() || !all.contains(box) || std::cmp_not_equal(values.size(), box.voxels())) {
    throw Error(ErrorKind::internal, cat(volume_.name, ": read of box ", box_text(box), " into ", values.size(),
                                         " values does not fit ", box_text(all)));
  }
  const Index3& c = volume_.chunk;
  const Index3 first{box.lo.x / c.x, box.lo.y / c.y, box.lo.z / c.z};
  const Index3 last{(box.hi.x - 1) / c.x, (box.hi.y - 1) / c.y, (box.hi.z - 1) / c.z};
  const Index3 count = last - first + Index3{1, 1, 1};
  const std::int64_t chunks = weir::volume(count);

  std::atomic<std::int64_t> next{0};
  std::mutex adding;
  ConversionLoss total;
  const auto lanes = std::min(static_cast<std::int64_t>(scratch_.size()), chunks);
  tbb::parallel_for(std::int64_t{0}, lanes, [&](std::int64_t) {
    const ScratchPool::Lease scratch(scratch_);
    ConversionLoss loss;
    try {
      for (std::int64_t i = next++; i < chunks; i = next++) {
        loss.add(read_chunk(first + index_at(i, count), box, values, *scratch));
      }
    } catch (...) {
      next = chunks;  // makes the other lanes end, too
      throw;
    }
    const std::lock_guard lock(adding);
    total.add(loss);
  });
  return total;
}

}  // namespace weir
