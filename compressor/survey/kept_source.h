// The volume as what comes after the survey reads it: out of memory what that kept there, the rest from its source.
#pragma once

#include "compressor/survey/kept_leaves.h"
#include "ingest/plan/staging.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// For stream_blocks(): of `source`, which the values of `kept` are from; both must outlive it. A box is read from the
/// source where one of its leaves is not kept, and where `kept` is null.
class KeptSource final : public VolumeSource {
 public:
  KeptSource(VolumeSource& source, const KeptLeaves* kept) : source_(source), kept_(kept) {}

  const SourceInfo& info() const override { return source_.info(); }
  AccessShape access() const override { return source_.access(); }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    if (!has(box)) return source_.read(box, values);
    kept_->copy(box, values, kIoThreads);
    return {};  // counted by the survey
  }
  std::vector<Box> voxels_with_values(const Box& box) const override { return source_.voxels_with_values(box); }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override {
    return has(box) ? std::vector<RepeatedPart>{{box}} : source_.repeated_parts(box);
  }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    return source_.read_repeated(part, values);
  }
  const HeldLeaves* held(const Box& box) const override { return has(box) ? kept_ : nullptr; }
  std::uint64_t working_bytes() const override { return source_.working_bytes(); }
  std::uint64_t bytes_read() const override { return source_.bytes_read(); }

 private:
  bool has(const Box& box) const { return kept_ != nullptr && kept_->has(box); }

  VolumeSource& source_;
  const KeptLeaves* kept_;
};

}  // namespace weir
