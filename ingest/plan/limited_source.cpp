#include "ingest/plan/limited_source.h"

#include <mutex>
#include <utility>

namespace weir {
namespace {

class LimitedSource final : public VolumeSource {
 public:
  LimitedSource(std::unique_ptr<VolumeSource> source, Bandwidth& bandwidth)
      : source_(std::move(source)), bandwidth_(bandwidth) {}

  const SourceInfo& info() const override { return source_->info(); }
  AccessShape access() const override { return source_->access(); }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    const ConversionLoss loss = source_->read(box, values);
    spend();
    return loss;
  }
  bool in_memory() const override { return source_->in_memory(); }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    const ConversionLoss loss = source_->read_alone(box, values);
    spend();
    return loss;
  }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override { return source_->repeated_parts(box); }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    const ConversionLoss loss = source_->read_repeated(part, values);
    spend();
    return loss;
  }
  std::vector<Box> voxels_with_values(const Box& box) const override { return source_->voxels_with_values(box); }
  std::uint64_t working_bytes() const override { return source_->working_bytes(); }
  std::uint64_t bytes_read() const override { return source_->bytes_read(); }

 private:
  // Several threads may be reading: each pays for what came in since another one paid.
  void spend() {
    std::uint64_t bytes = 0;
    {
      const std::scoped_lock lock(mutex_);
      const std::uint64_t read = source_->bytes_read();
      bytes = read - std::exchange(paid_, read);
    }
    bandwidth_.spend(bytes);
  }

  std::unique_ptr<VolumeSource> source_;
  Bandwidth& bandwidth_;
  std::mutex mutex_;
  std::uint64_t paid_ = 0;
};

}  // namespace

std::unique_ptr<VolumeSource> limit_source(std::unique_ptr<VolumeSource> source, Bandwidth& bandwidth) {
  return std::make_unique<LimitedSource>(std::move(source), bandwidth);
}

}  // namespace weir
