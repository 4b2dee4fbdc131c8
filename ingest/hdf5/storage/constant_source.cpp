#include "ingest/hdf5/storage/constant_source.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include "ingest/values/decode_values.h"

namespace weir {
namespace {

class ConstantSource final : public VolumeSource {
 public:
  ConstantSource(double value, SourceInfo info) : info_(std::move(info)) {
    info_.type = ScalarType::float64;
    loss_ = decode_values(std::as_bytes(std::span(&value, 1)), info_.type, std::endian::native == std::endian::big,
                          info_.mapping, {&value_, 1});
  }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {sizeof(double), {}, {}}; }
  bool in_memory() const override { return true; }
  std::uint64_t bytes_read() const override { return 0; }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    std::ranges::fill(values, value_);
    return loss_.times(static_cast<std::uint64_t>(box.voxels()));
  }

 private:
  SourceInfo info_;
  float value_ = 0;
  ConversionLoss loss_;  ///< of one voxel
};

}  // namespace

std::unique_ptr<VolumeSource> make_constant_source(double value, SourceInfo info) {
  return std::make_unique<ConstantSource>(value, std::move(info));
}

}  // namespace weir
