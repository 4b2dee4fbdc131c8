#include "tests/compressor/support/memory_volume.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace weir::test {
namespace {

std::vector<float> values_of(const Box& domain, const std::function<float(const Index3&)>& value) {
  std::vector<float> values(static_cast<std::size_t>(domain.voxels()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = value(domain.lo + index_at(static_cast<std::int64_t>(i), domain.extent()));
  }
  return values;
}

std::vector<float> values_of(VolumeSource& source) {
  std::vector<float> values(static_cast<std::size_t>(source.info().domain().voxels()));
  source.read(source.info().domain(), values);
  return values;
}

}  // namespace

MemoryVolume::MemoryVolume(const Box& domain, std::vector<float> values) : values_(std::move(values)) {
  if (static_cast<std::int64_t>(values_.size()) != domain.voxels()) throw std::invalid_argument("values of a volume");
  info_.path = "memory";
  info_.format = "memory";
  info_.extent = domain.extent();
  info_.index_origin = domain.lo;
  info_.file_bytes = values_.size() * sizeof(float);
}

MemoryVolume::MemoryVolume(const Box& domain, const std::function<float(const Index3&)>& value)
    : MemoryVolume(domain, values_of(domain, value)) {}

MemoryVolume::MemoryVolume(VolumeSource& source) : MemoryVolume(source.info().domain(), values_of(source)) {
  info_.type = source.info().type;
}

MemoryVolume::MemoryVolume(MemoryVolume&& other) noexcept
    : info_(std::move(other.info_)),
      access_(other.access_),
      values_(std::move(other.values_)),
      bytes_read_(other.bytes_read_.load()) {}

ConversionLoss MemoryVolume::read(const Box& box, std::span<float> values) {
  if (!info_.domain().contains(box) || static_cast<std::size_t>(box.voxels()) != values.size()) {
    throw std::invalid_argument("a read outside the volume, or into another size");
  }
  float* to = values.data();
  for_each_row(box, [&to](std::span<const float> row) { to = std::copy(row.begin(), row.end(), to); });
  bytes_read_ += values.size_bytes();
  return {};
}

float MemoryVolume::at(const Index3& i) const {
  return values_[static_cast<std::size_t>(linear_index(i - info_.index_origin, info_.extent))];
}

std::vector<float> MemoryVolume::in(const Box& box) const {
  const Box inside = intersect(box, info_.domain());
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(inside.voxels()));
  for_each_row(inside, [&values](std::span<const float> row) { values.insert(values.end(), row.begin(), row.end()); });
  return values;
}

void MemoryVolume::for_each_row(const Box& inside, const std::function<void(std::span<const float>)>& use) const {
  for (std::int64_t z = inside.lo.z; z < inside.hi.z; ++z) {
    for (std::int64_t y = inside.lo.y; y < inside.hi.y; ++y) {
      const Index3 first = Index3{inside.lo.x, y, z} - info_.index_origin;
      use({&values_[static_cast<std::size_t>(linear_index(first, info_.extent))],
           static_cast<std::size_t>(inside.extent().x)});
    }
  }
}

}  // namespace weir::test
