// Base class of sources that change a part of another source: it forwards every call.
#pragma once

#include <memory>
#include <utility>

#include "ingest/source/volume_source.h"

namespace weir {

/// Forwards every call to the source that it holds.
class ForwardedSource : public VolumeSource {
 public:
  explicit ForwardedSource(std::unique_ptr<VolumeSource> source) : owned_(std::move(source)), source_(*owned_) {}
  /// `source` must outlive this object.
  explicit ForwardedSource(VolumeSource& source) : source_(source) {}

  const SourceInfo& info() const override { return source_.info(); }
  AccessShape access() const override { return source_.access(); }
  ConversionLoss read(const Box& box, std::span<float> values) override { return source_.read(box, values); }
  bool in_memory() const override { return source_.in_memory(); }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    return source_.read_alone(box, values);
  }
  ResidentVolume* resident() override { return source_.resident(); }
  const CellPlaces* places() const override { return source_.places(); }
  std::vector<Box> voxels_with_values(const Box& box) const override { return source_.voxels_with_values(box); }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override { return source_.repeated_parts(box); }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    return source_.read_repeated(part, values);
  }
  const HeldLeaves* held(const Box& box) const override { return source_.held(box); }
  std::uint64_t working_bytes() const override { return source_.working_bytes(); }
  std::uint64_t bytes_read() const override { return source_.bytes_read(); }

 protected:
  VolumeSource& source() const { return source_; }

 private:
  std::unique_ptr<VolumeSource> owned_;
  VolumeSource& source_;
};

}  // namespace weir
