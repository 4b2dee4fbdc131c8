// A remote grid as a source: it reads voxels from the blocks that are held (remote_grid.h).
#pragma once

#include <cstdint>
#include <span>

#include "format/remote/remote_grid.h"
#include "ingest/source/volume_source.h"

namespace weir::python {

class RemoteSource final : public VolumeSource {
 public:
  /// `grid` must outlive the source.
  explicit RemoteSource(const RemoteGrid& grid);

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override;
  /// Call it within RemoteGrid::with_blocks() for a box that holds `box`.
  ConversionLoss read(const Box& box, std::span<float> values) override;
  std::uint64_t bytes_read() const override { return 0; }

 private:
  const RemoteGrid& grid_;
  SourceInfo info_;
};

}  // namespace weir::python
