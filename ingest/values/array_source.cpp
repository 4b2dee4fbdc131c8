#include "ingest/values/array_source.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/extent.h"
#include "ingest/source/source_view.h"
#include "ingest/values/convert_values.h"
#include "ingest/values/decode_values.h"

namespace weir {
namespace {

constexpr std::string_view kPath = "memory";

/// Tile size for arrays with another fastest axis than x: kTileRows rows of kTileVoxels values are gathered at a
/// time, so that a cache line is used up while it is in the cache. This is 32 KiB of the widest type.
constexpr std::int64_t kTileVoxels = 256;
constexpr std::int64_t kTileRows = 16;
constexpr std::size_t kWidest = 8;

/// Copies `count` values of `Bytes` bytes each. `from` and `to` are the steps in bytes.
template <std::size_t Bytes>
void copy_values(const std::byte* source, std::int64_t from, std::byte* target, std::int64_t to, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) std::memcpy(target + i * to, source + i * from, Bytes);
}

void copy_values(std::size_t bytes, const std::byte* source, std::int64_t from, std::byte* target, std::int64_t to,
                 std::int64_t count) {
  switch (bytes) {
    case 1:
      return copy_values<1>(source, from, target, to, count);
    case 2:
      return copy_values<2>(source, from, target, to, count);
    case 4:
      return copy_values<4>(source, from, target, to, count);
    default:
      return copy_values<8>(source, from, target, to, count);
  }
}

class ArraySource final : public VolumeSource {
 public:
  ArraySource(const DenseArray& array, SourceInfo info)
      : first_(static_cast<const std::byte*>(array.data)),
        stride_(array.stride),
        bytes_(static_cast<std::int64_t>(scalar_bytes(array.type))),
        info_(std::move(info)) {}

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {static_cast<std::size_t>(bytes_), {}, {}}; }
  bool in_memory() const override { return true; }
  std::uint64_t bytes_read() const override { return bytes_read_; }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    if (box.empty() || !info_.domain().contains(box) || std::cmp_not_equal(values.size(), box.voxels())) {
      throw Error(ErrorKind::internal, cat(kPath, ": read of box ", box_text(box), " into ", values.size(),
                                           " values does not fit ", box_text(info_.domain())));
    }
    bytes_read_ += static_cast<std::uint64_t>(box.voxels() * bytes_);
    return stride_[0] == bytes_ ? read_runs(box, values) : read_tiles(box, values);
  }

 private:
  const std::byte* at(const Index3& i) const {
    return first_ + (i.x * stride_[0] + i.y * stride_[1] + i.z * stride_[2]);
  }
  ConversionLoss decode(const std::byte* from, std::span<float> values) const {
    return decode_values({from, values.size_bytes() / sizeof(float) * static_cast<std::size_t>(bytes_)}, info_.type,
                         kNativeIsBig, info_.mapping, values);
  }

  // Reads rows that already lie in the array as they are wanted. Rows without a gap between them are read as one.
  ConversionLoss read_runs(const Box& box, std::span<float> values) const {
    const Index3 e = box.extent();
    const bool rows_join = stride_[1] == e.x * bytes_;
    const bool planes_join = rows_join && stride_[2] == e.x * e.y * bytes_;
    const std::int64_t run = e.x * (rows_join ? e.y : 1) * (planes_join ? e.z : 1);
    ConversionLoss loss;
    for (std::int64_t i = 0; i < box.voxels(); i += run) {
      loss.add(decode(at(box.lo + index_at(i, e)),
                      values.subspan(static_cast<std::size_t>(i), static_cast<std::size_t>(run))));
    }
    return loss;
  }

  // Gathers tiles of rows along x. The rows of a tile are neighbours along the faster of y and z.
  ConversionLoss read_tiles(const Box& box, std::span<float> values) const {
    const bool y_faster = std::abs(stride_[1]) <= std::abs(stride_[2]);
    const Index3 step = y_faster ? Index3{kTileVoxels, kTileRows, 1} : Index3{kTileVoxels, 1, kTileRows};
    ConversionLoss loss;
    for (std::int64_t z = box.lo.z; z < box.hi.z; z += step.z) {
      for (std::int64_t y = box.lo.y; y < box.hi.y; y += step.y) {
        for (std::int64_t x = box.lo.x; x < box.hi.x; x += step.x) {
          const Index3 lo{x, y, z};
          loss.add(read_tile({lo, min(lo + step, box.hi)}, y_faster ? 1 : 2, box, values));
        }
      }
    }
    return loss;
  }

  ConversionLoss read_tile(const Box& tile, std::size_t row_axis, const Box& box, std::span<float> values) const {
    alignas(kWidest) std::array<std::byte, kTileVoxels * kTileRows * kWidest> gathered;
    const Index3 e = tile.extent();
    const std::int64_t rows = e.y * e.z;
    const std::int64_t across = stride_[row_axis];
    const auto bytes = static_cast<std::size_t>(bytes_);
    const std::byte* const source = at(tile.lo);
    const std::int64_t row_bytes = e.x * bytes_;
    if (std::abs(stride_[0]) <= std::abs(across)) {
      for (std::int64_t r = 0; r < rows; ++r) {
        copy_values(bytes, source + r * across, stride_[0], gathered.data() + r * row_bytes, bytes_, e.x);
      }
    } else {
      for (std::int64_t x = 0; x < e.x; ++x) {
        copy_values(bytes, source + x * stride_[0], across, gathered.data() + x * bytes_, row_bytes, rows);
      }
    }
    ConversionLoss loss;
    for (std::int64_t r = 0; r < rows; ++r) {
      const Index3 row = tile.lo + (row_axis == 1 ? Index3{0, r, 0} : Index3{0, 0, r});
      loss.add(decode(gathered.data() + r * row_bytes,
                      values.subspan(static_cast<std::size_t>(linear_index(row - box.lo, box.extent())),
                                     static_cast<std::size_t>(e.x))));
    }
    return loss;
  }

  const std::byte* first_;
  std::array<std::int64_t, 3> stride_;  // bytes
  std::int64_t bytes_;                  // bytes of a value
  SourceInfo info_;
  std::atomic<std::uint64_t> bytes_read_{0};
};

void check_place(const DenseArray& array) {
  for (const double s : array.spacing) {
    if (!(s > 0.0) || !std::isfinite(s)) {
      throw Error(ErrorKind::usage, cat(kPath, ": the spacing has ", s, "; each must be finite and above 0"));
    }
    if (s < kLeastSpacing || s > kMostSpacing) {
      throw Error(ErrorKind::usage, cat(kPath, ": the spacing has ", s, "; each must be within 1e-37 and 1e+37"));
    }
  }
  for (const double o : array.origin) {
    if (std::isfinite(o) && std::fabs(o) <= kMostOrigin) continue;
    throw Error(ErrorKind::usage, cat(kPath, ": the origin has ", o, "; each must be ",
                                      std::isfinite(o) ? "within -1e+37 and 1e+37" : "finite"));
  }
  const std::string why = too_far_away({{}, array.extent}, array.spacing, array.origin);
  if (!why.empty()) throw Error(ErrorKind::usage, cat(kPath, ": ", why, "; give a smaller spacing"));
}

}  // namespace

std::array<std::int64_t, 3> packed_stride(const Index3& extent, ScalarType type) {
  // Computes in unsigned numbers, which may overflow. array_info refuses such an extent later.
  const std::uint64_t bytes = scalar_bytes(type);
  const std::uint64_t row = bytes * static_cast<std::uint64_t>(extent.x);
  const std::uint64_t plane = row * static_cast<std::uint64_t>(extent.y);
  return {static_cast<std::int64_t>(bytes), static_cast<std::int64_t>(row), static_cast<std::int64_t>(plane)};
}

void check_strides(std::string_view path, const Index3& extent, const std::array<std::int64_t, 3>& stride) {
  const std::array<std::int64_t, 3> voxels{extent.x, extent.y, extent.z};
  std::int64_t reach = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    std::int64_t along = 0;
    if (stride[a] == std::numeric_limits<std::int64_t>::min() ||
        __builtin_mul_overflow(std::abs(stride[a]), voxels[a] - 1, &along) ||
        __builtin_add_overflow(reach, along, &reach)) {
      throw Error(ErrorKind::usage, cat(path, ": a stride of ", stride[a], " bytes along ", "xyz"[a], " for ",
                                        voxels[a], " voxels leaves the address space; strides are in bytes"));
    }
  }
}

SourceInfo array_info(const DenseArray& array) {
  SourceInfo info;
  info.path = kPath;
  info.format = "memory";
  // Memory has no modification time. The time of this call is unique to the array, so that no interrupted conversion
  // of another array is continued with it.
  info.mtime_ns = std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  info.file_bytes = checked_volume_bytes(array.extent, scalar_bytes(array.type), info.path);
  check_place(array);
  for (const StoredValue& value : array.missing) {
    if (holds(array.type, value)) continue;
    throw Error(ErrorKind::usage, cat(kPath, ": the missing value is ", stored_value_text(value), ", and no ",
                                      scalar_name(array.type), " is; give a value of that type"));
  }
  info.dataset = array.name;
  info.extent = array.extent;
  info.type = array.type;
  info.mapping.missing = array.missing;
  info.mapping.keeps_missing = array.keeps_missing;
  info.spacing = array.spacing;
  info.origin = array.origin;
  info.units = array.units;
  info.axis_labels = array.axis_labels;
  info.details = array.details;
  return info;
}

std::unique_ptr<VolumeSource> open_array(const DenseArray& array) {
  SourceInfo info = array_info(array);
  if (array.data == nullptr) throw Error(ErrorKind::usage, cat(kPath, ": the array's data is a null pointer"));
  check_strides(kPath, array.extent, array.stride);
  return std::make_unique<ArraySource>(array, std::move(info));
}

}  // namespace weir
