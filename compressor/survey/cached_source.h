// The volume for the passes after the survey: values that the survey cached come from memory, the rest from the source.
#pragma once

#include "compressor/survey/leaf_cache.h"
#include "ingest/plan/staging.h"
#include "ingest/source/forwarded_source.h"

namespace weir {

/// A source for stream_blocks(). `cache` holds values of `source`; both must outlive the object. A box is read from
/// `source` if one of its leaves is not cached, or if `cache` is null.
class CachedSource final : public ForwardedSource {
 public:
  CachedSource(VolumeSource& source, const LeafCache* cache) : ForwardedSource(source), cache_(cache) {}

  ConversionLoss read(const Box& box, std::span<float> values) override {
    if (!has(box)) return source().read(box, values);
    cache_->copy(box, values, kIoThreads);
    return {};  // the survey has counted the loss
  }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    if (!has(box)) return source().read_alone(box, values);
    cache_->copy(box, values, 1);
    return {};
  }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override {
    return has(box) ? std::vector<RepeatedPart>{{box}} : source().repeated_parts(box);
  }
  const HeldLeaves* held(const Box& box) const override { return has(box) ? cache_ : source().held(box); }

 private:
  bool has(const Box& box) const { return cache_ != nullptr && cache_->has(box); }

  const LeafCache* cache_;
};

}  // namespace weir
