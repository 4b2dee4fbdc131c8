// The volume as what comes after the survey reads it: out of memory what that cached there, the rest from its source.
#pragma once

#include "compressor/survey/leaf_cache.h"
#include "ingest/plan/staging.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// For stream_blocks(): of `source`, which the values of `cache` are from; both must outlive it. A box is read from the
/// source where one of its leaves is not cached, and where `cache` is null.
class CachedSource final : public VolumeSource {
 public:
  CachedSource(VolumeSource& source, const LeafCache* cache) : source_(source), cache_(cache) {}

  const SourceInfo& info() const override { return source_.info(); }
  AccessShape access() const override { return source_.access(); }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    if (!has(box)) return source_.read(box, values);
    cache_->copy(box, values, kIoThreads);
    return {};  // counted by the survey
  }
  std::vector<Box> voxels_with_values(const Box& box) const override { return source_.voxels_with_values(box); }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override {
    return has(box) ? std::vector<RepeatedPart>{{box}} : source_.repeated_parts(box);
  }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    return source_.read_repeated(part, values);
  }
  const HeldLeaves* held(const Box& box) const override { return has(box) ? cache_ : nullptr; }
  std::uint64_t working_bytes() const override { return source_.working_bytes(); }
  std::uint64_t bytes_read() const override { return source_.bytes_read(); }

 private:
  bool has(const Box& box) const { return cache_ != nullptr && cache_->has(box); }

  VolumeSource& source_;
  const LeafCache* cache_;
};

}  // namespace weir
