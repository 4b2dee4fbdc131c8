#include "gpu/cuda/render/brick_volume.h"

#include <memory>
#include <utility>

#include "gpu/cuda/bricks/packed_source.h"
#include "gpu/cuda/bricks/table_source.h"

namespace weir {

BrickVolume::BrickVolume(const NvdbGrid& grid, GridBytes bytes, const std::vector<MinMax>& cells, BrickBudget budget)
    : bytes_(std::move(bytes)), cells_(cells) {
  std::unique_ptr<BlockSource> source;
  budget.taken = cells_.bytes() + bytes_.device_bytes();
  if (grid.packed() != nullptr) {
    source = std::make_unique<PackedSource>(grid, bytes_.data());
    budget.taken += BlockDecoder::kFixedBytes;
  } else {
    const auto read_in_place = [&]<class Block>(DeviceTable<Block> table) {
      table_ = std::move(table);
      const auto& kept = std::get<DeviceTable<Block>>(table_);
      budget.taken += kept.bytes();
      source = std::make_unique<TableSource<Block>>(grid, kept.view());
    };
    if (grid.type() == GridType::float32) {
      read_in_place(DeviceTable<FloatBlock>(grid, bytes_.data()));
    } else {
      read_in_place(DeviceTable<QuantisedBlock>(grid, bytes_.data()));
    }
  }
  cache_.emplace(std::move(source), budget);
}

}  // namespace weir
