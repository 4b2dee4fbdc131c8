#include "compressor/push/resident_source.h"

#include <atomic>
#include <utility>

namespace weir {
namespace {

class ResidentSource final : public VolumeSource {
 public:
  ResidentSource(std::unique_ptr<ResidentVolume> resident, SourceInfo info)
      : resident_(std::move(resident)), info_(std::move(info)) {}

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {}; }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    resident_->read(box, values);
    bytes_read_ += values.size_bytes();
    return {};
  }
  ResidentVolume* resident() override { return resident_.get(); }
  std::uint64_t working_bytes() const override { return resident_->host_bytes(); }
  std::uint64_t bytes_read() const override { return bytes_read_; }

 private:
  std::unique_ptr<ResidentVolume> resident_;
  SourceInfo info_;
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace

std::unique_ptr<VolumeSource> open_resident(std::unique_ptr<ResidentVolume> resident, SourceInfo info) {
  return std::make_unique<ResidentSource>(std::move(resident), std::move(info));
}

}  // namespace weir
