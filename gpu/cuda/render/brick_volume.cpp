#include "gpu/cuda/render/brick_volume.h"

#include <memory>
#include <utility>

#include "gpu/cuda/bricks/packed_source.h"
#include "gpu/cuda/bricks/table_source.h"

namespace weir {

BrickVolume::BrickVolume(const NvdbGrid& grid, GridBytes bytes, const std::vector<MinMax>& cells, BrickBudget budget)
    : bytes_(std::move(bytes)), cells_(cells), level_bytes_(budget.levels) {
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

bool BrickVolume::shrink(std::uint64_t bytes, const std::string& why) {
  levels_.reset();  // a picture with levels makes them again
  return cache_->shrink(bytes, why);
}

int BrickVolume::finest_level(int wanted) const {
  const BlockLattice lattice = cache_->source().lattice();
  return DevicePyramid::finest_within({lattice.shift, lattice.extent}, wanted, level_bytes_);
}

const DevicePyramid& BrickVolume::levels(int finest) {
  if (!levels_ || levels_->first() != finest) {
    levels_.reset();
    levels_.emplace(cache_->source(), cache_->regions(), finest, level_bytes_);
  }
  return *levels_;
}

DeviceMacrocells BrickVolume::levelled_cells(int finest, const CellLattice& cells, const LevelChoice& choice,
                                             bool draft) {
  return DeviceMacrocells(levels(finest).bounds(cells, cells_.bounds(), choice, draft && cache_->paged()));
}

}  // namespace weir
