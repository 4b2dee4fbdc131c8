// Presents the sample of a volume as a volume of its own that can be converted.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "compressor/forecast/sample_places.h"
#include "compressor/forecast/sample_plan.h"
#include "compressor/forecast/varied_regions.h"
#include "compressor/survey/visibility.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Reads the sample of `plan` from `source`, which must outlive the object. `source` is the volume that the plan was
/// made for, or a copy of the sample if the plan is one of its SamplePlan::parts. Reading also finds which regions
/// vary, as far as `seen` shows them; `seen` may be null.
class SampledSource final : public VolumeSource {
 public:
  enum class From { volume, copy };
  SampledSource(VolumeSource& source, const SamplePlan& plan, From from = From::volume,
                const Visibility* seen = nullptr);

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return plan_.access(source_.access()); }
  ConversionLoss read(const Box& box, std::span<float> values) override;
  bool in_memory() const override { return source_.in_memory(); }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override;
  const CellPlaces* places() const override { return plan_.whole() ? source_.places() : &places_; }
  std::uint64_t working_bytes() const override;
  /// Finds the values that lookups around the sample's leaves can touch, for places(). Reads the volume once more
  /// around the cells. Does nothing if the volume has chunks, because chunks are decoded whole.
  void find_reaches(const std::atomic<bool>* cancel);
  /// Returns the bytes read since this object was made.
  std::uint64_t bytes_read() const override { return source_.bytes_read() - read_before_; }
  std::int64_t voxels_read() const { return voxels_read_; }
  /// Return the number of 128^3 regions, of the volume and of the sample, with more than one value among those read.
  /// Return 0 if the source is a copy, or if the sample is the whole volume.
  std::uint64_t varied_in_volume() const { return in_volume_.count(); }
  std::uint64_t varied_in_sample() const { return in_sample_.count(); }
  /// Returns the share of the read voxels in places with more than one value. An encode pass reads these voxels again.
  double varied_share() const;

 private:
  /// The part of a place to read.
  struct Piece {
    Box to;       ///< box in the sample
    Index3 from;  ///< lowest voxel in the source
  };
  std::vector<Piece> pieces_of(const Box& box) const;
  ConversionLoss read_piece(const Piece& piece, const Box& box, std::span<float> values, bool alone);
  void note_ranges(const Piece& piece, std::span<const float> values);

  VolumeSource& source_;
  SamplePlan plan_;
  SamplePlaces places_;
  std::optional<SampleReaches> reaches_;
  From from_;
  const Visibility* seen_;
  SourceInfo info_;
  std::uint64_t read_before_;
  std::atomic<std::int64_t> voxels_read_{0};
  mutable std::mutex mutex_;  // guards the members below
  std::int64_t varied_voxels_ = 0;
  VariedRegions in_volume_;
  VariedRegions in_sample_;
};

}  // namespace weir
