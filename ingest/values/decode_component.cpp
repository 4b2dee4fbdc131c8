#include "ingest/values/decode_component.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "format/base/load_scalar.h"
#include "ingest/values/convert_values.h"
#include "ingest/values/decode_values.h"
#include "ingest/values/vector_lengths.h"

namespace weir {
namespace {

/// Number of voxels decoded at a time: the temporaries stay in the first-level cache.
constexpr std::size_t kVoxelsAtOnce = 512;
constexpr std::size_t kLargestScalar = sizeof(double);

/// Copies one number of `Width` bytes from every `stride` bytes, and puts the numbers side by side.
template <std::size_t Width>
void gather(const std::byte* from, std::size_t stride, std::size_t count, std::byte* to) {
  for (std::size_t i = 0; i < count; ++i) std::memcpy(to + i * Width, from + i * stride, Width);
}

void gather(const std::byte* from, std::size_t width, std::size_t stride, std::size_t count, std::byte* to) {
  if (width == 1) return gather<1>(from, stride, count, to);
  if (width == 2) return gather<2>(from, stride, count, to);
  if (width == 4) return gather<4>(from, stride, count, to);
  gather<8>(from, stride, count, to);
}

template <typename T>
void widen(std::span<const std::byte> bytes, bool big_endian, const ValueMapping& mapping, std::span<double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const T stored = load_scalar<T>(bytes.data() + i * sizeof(T), big_endian);
    numbers[i] = mapping.scales() ? static_cast<double>(mapping.scaled(stored)) : static_cast<double>(stored);
  }
}

/// Decodes numbers to double, after scale and offset.
void scaled_numbers(std::span<const std::byte> bytes, ScalarType type, bool big_endian, const ValueMapping& mapping,
                    std::span<double> numbers) {
  switch (type) {
    case ScalarType::uint32:
      return widen<std::uint32_t>(bytes, big_endian, mapping, numbers);
    case ScalarType::int32:
      return widen<std::int32_t>(bytes, big_endian, mapping, numbers);
    case ScalarType::uint64:
      return widen<std::uint64_t>(bytes, big_endian, mapping, numbers);
    case ScalarType::int64:
      return widen<std::int64_t>(bytes, big_endian, mapping, numbers);
    case ScalarType::float64:
      return widen<double>(bytes, big_endian, mapping, numbers);
    default:  // exact in float32
      break;
  }
  std::array<float, kVoxelsAtOnce> floats;
  convert_values(bytes, type, big_endian, std::span(floats).first(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = mapping.scales() ? mapping.scaled(floats[i]) : static_cast<double>(floats[i]);
  }
}

class Magnitudes {
 public:
  Magnitudes(ScalarType type, bool big_endian, const ValueMapping& mapping)
      : type_(type), big_endian_(big_endian), mapping_(mapping), marking_(mapping) {
    marking_.keeps_missing = false;
  }

  /// Adds the next component of `voxels` voxels.
  void add(std::span<const std::byte> bytes, std::size_t voxels) {
    const auto numbers = std::span(numbers_).first(voxels);
    scaled_numbers(bytes, type_, big_endian_, mapping_, numbers);
    for (std::size_t i = 0; i < voxels; ++i) sums_[i] += squared_part(numbers[i]);
    if (mapping_.missing.empty()) return;
    const auto marked = std::span(marked_).first(voxels);
    decode_values(bytes, type_, big_endian_, marking_, marked);
    for (std::size_t i = 0; i < voxels; ++i) missing_[i] = missing_[i] || is_missing(marked[i]);
  }
  /// Computes the lengths from the components that were added, and begins anew.
  ConversionLoss take(std::span<float> values) {
    const auto without =
        std::count(missing_.begin(), missing_.begin() + static_cast<std::ptrdiff_t>(values.size()), true);
    if (mapping_.keeps_missing) missing_ = {};  // missing values count as data
    ConversionLoss loss = take_lengths(std::span(sums_).first(values.size()),
                                       std::span<const bool>(missing_).first(values.size()), values);
    if (mapping_.keeps_missing) loss.unmarked = static_cast<std::uint64_t>(without);
    sums_ = {};
    missing_ = {};
    return loss;
  }

 private:
  ScalarType type_;
  bool big_endian_;
  const ValueMapping& mapping_;
  ValueMapping marking_;  ///< mapping_ with missing values marked in any case
  std::array<double, kVoxelsAtOnce> sums_{};
  std::array<bool, kVoxelsAtOnce> missing_{};
  std::array<double, kVoxelsAtOnce> numbers_{};
  std::array<float, kVoxelsAtOnce> marked_{};
};

}  // namespace

ConversionLoss decode_component(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                                const ValueMapping& mapping, const VoxelComponents& components,
                                std::span<float> values) {
  if (components.count == 1) return decode_values(bytes, type, big_endian, mapping, values);
  const std::size_t width = scalar_bytes(type);
  const auto count = static_cast<std::size_t>(components.count);
  std::array<std::byte, kVoxelsAtOnce * kLargestScalar> gathered;
  Magnitudes magnitudes(type, big_endian, mapping);
  ConversionLoss loss;
  for (std::size_t start = 0; start < values.size(); start += kVoxelsAtOnce) {
    const auto part = values.subspan(start, std::min(kVoxelsAtOnce, values.size() - start));
    const auto numbers = std::span<const std::byte>(gathered).first(part.size() * width);
    const std::byte* const voxel = bytes.data() + start * count * width;
    if (components.choice.magnitude) {
      for (std::size_t c = 0; c < count; ++c) {
        gather(voxel + c * width, width, count * width, part.size(), gathered.data());
        magnitudes.add(numbers, part.size());
      }
      loss.add(magnitudes.take(part));
    } else {
      const auto c = static_cast<std::size_t>(components.choice.position);
      gather(voxel + c * width, width, count * width, part.size(), gathered.data());
      loss.add(decode_values(numbers, type, big_endian, mapping, part));
    }
  }
  return loss;
}

}  // namespace weir
