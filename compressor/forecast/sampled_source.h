// The sample of a volume as a volume, for whoever converts volumes.
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

/// Of `source`, which must outlive it: of the volume that the plan was made for, or of a copy of the sample that the
/// plan is a part of (SamplePlan::parts). Reading it also finds which regions vary, as far as `seen`, which may be
/// null, shows them.
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
  /// Finds what lookups can touch of its leaves, for places(): reads the volume once more around its cells. Not where
  /// the volume has chunks, which are decoded whole.
  void find_reaches(const std::atomic<bool>* cancel);
  /// Since this object was made.
  std::uint64_t bytes_read() const override { return source_.bytes_read() - read_before_; }
  std::int64_t voxels_read() const { return voxels_read_; }
  /// Regions of 128^3 voxels of the volume, and of the sample, that hold more than one of the values read. Of a sample
  /// of a volume; else 0.
  std::uint64_t varied_in_volume() const { return in_volume_.count(); }
  std::uint64_t varied_in_sample() const { return in_sample_.count(); }
  /// Part of the voxels read that lie in places of more than one value: what an encode pass reads again.
  double varied_share() const;

 private:
  /// A part of a place that is read.
  struct Piece {
    Box to;       ///< in the sample
    Index3 from;  ///< its corner in the source
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
  mutable std::mutex mutex_;  // of what follows
  std::int64_t varied_voxels_ = 0;
  VariedRegions in_volume_;
  VariedRegions in_sample_;
};

}  // namespace weir
