// A volume held in memory, as a source: any domain, any values, any shape of access.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ingest/source/volume_source.h"

namespace weir::test {

class MemoryVolume final : public VolumeSource {
 public:
  /// Holds `values` over `domain`, x fastest.
  MemoryVolume(const Box& domain, std::vector<float> values);
  /// Holds value(i) at every index i of `domain`.
  MemoryVolume(const Box& domain, const std::function<float(const Index3&)>& value);
  /// Holds all values of `source`.
  explicit MemoryVolume(VolumeSource& source);
  MemoryVolume(MemoryVolume&& other) noexcept;

  /// Name, spacing, origin and scalar type may be changed before the volume is used.
  SourceInfo& info() { return info_; }
  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return access_; }
  void set_access(const AccessShape& access) { access_ = access; }
  ConversionLoss read(const Box& box, std::span<float> values) override;
  std::uint64_t bytes_read() const override { return bytes_read_; }

  std::span<const float> values() const { return values_; }
  float at(const Index3& i) const;
  /// Returns the values of the part of `box` that lies in the domain, x fastest.
  std::vector<float> in(const Box& box) const;

 private:
  /// Calls use(values) for each row along x of `inside`, a part of the domain, in order.
  void for_each_row(const Box& inside, const std::function<void(std::span<const float>)>& use) const;

  SourceInfo info_;
  AccessShape access_;
  std::vector<float> values_;
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace weir::test
