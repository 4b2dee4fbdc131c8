#include "compressor/forecast/sample_copy.h"

#include <utility>
#include <vector>

#include "compressor/conversion_control.h"
#include "ingest/plan/block_plan.h"

namespace weir {

// Calls action(offset in the file, index of the first value, number of values) for each run of values that are adjacent
// both in the file and in the box.
template <typename Action>
void SampleCopy::for_each_run(const Box& box, const Action& action) const {
  const Index3 extent = box.extent();
  const bool whole_rows = extent.x == info_.extent.x;
  const std::int64_t run = whole_rows ? extent.x * extent.y : extent.x;
  const std::int64_t runs = whole_rows ? 1 : extent.y;
  for (std::int64_t z = 0; z < extent.z; ++z) {
    for (std::int64_t y = 0; y < runs; ++y) {
      const std::int64_t at = linear_index(box.lo - info_.index_origin + Index3{0, y, z}, info_.extent);
      action(static_cast<std::uint64_t>(at) * sizeof(float), static_cast<std::size_t>((z * runs + y) * run),
             static_cast<std::size_t>(run));
    }
  }
}

SampleCopy::SampleCopy(VolumeSource& sample, std::unique_ptr<File> file, std::uint64_t block_bytes,
                       const std::atomic<bool>* cancel)
    : info_(sample.info()), places_(sample.places()), file_(std::move(file)) {
  const BlockPlan plan = plan_blocks(info_.domain(), sample.access(), block_bytes);
  std::vector<float> values;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    if (cancel != nullptr && *cancel) throw interrupted_error();
    const Box box = plan.voxel_box(plan.leaf_box(i));
    values.resize(static_cast<std::size_t>(box.voxels()));
    copied_loss_.add(sample.read(box, values));
    for_each_run(box, [&](std::uint64_t offset, std::size_t first, std::size_t count) {
      file_->write_at(offset, std::as_bytes(std::span(values).subspan(first, count)));
    });
  }
}

ConversionLoss SampleCopy::read(const Box& box, std::span<float> values) {
  for_each_run(box, [&](std::uint64_t offset, std::size_t first, std::size_t count) {
    file_->read_at(offset, std::as_writable_bytes(values.subspan(first, count)));
  });
  bytes_read_ += values.size_bytes();
  return {};
}

}  // namespace weir
