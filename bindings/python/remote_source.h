// The voxels of a remote grid, as any source has them: of the blocks that are there (remote_grid.h).
#pragma once

#include <cstdint>
#include <span>

#include "format/remote/remote_grid.h"
#include "ingest/source/volume_source.h"

namespace weir::python {

class RemoteSource final : public VolumeSource {
 public:
  /// `grid` must outlive it.
  explicit RemoteSource(const RemoteGrid& grid);

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override;
  /// To be called within RemoteGrid::with_blocks of a box that holds `box`.
  ConversionLoss read(const Box& box, std::span<float> values) override;
  std::uint64_t bytes_read() const override { return 0; }

 private:
  const RemoteGrid& grid_;
  SourceInfo info_;
};

}  // namespace weir::python
