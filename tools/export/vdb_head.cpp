#include "tools/export/vdb_head.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "format/base/text.h"
#include "ingest/vdb/grid_placement.h"

namespace weir {
namespace {

constexpr std::uint64_t kMagic = 0x56444220;
constexpr std::uint32_t kFileVersion = 224;  ///< written by OpenVDB 5 (2017) to 10
constexpr std::uint32_t kLibraryMajor = 10;
constexpr std::uint32_t kLibraryMinor = 0;

class Bytes {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void raw(const std::string& text) { bytes_ += text; }
  void text(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    raw(text);
  }
  std::size_t size() const { return bytes_.size(); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

void put_value(Bytes& out, const std::string& value) {
  out.text("string");
  out.text(value);
}
template <typename T>
void put_number(Bytes& out, const char* type, const T& value) {
  out.text(type);
  out.put(static_cast<std::uint32_t>(sizeof value));
  out.put(value);
}
void put_value(Bytes& out, double value) { put_number(out, "double", value); }
void put_value(Bytes& out, std::int64_t value) { put_number(out, "int64", value); }
void put_value(Bytes& out, bool value) { put_number(out, "bool", static_cast<std::uint8_t>(value)); }
void put_value(Bytes& out, const std::array<std::int32_t, 3>& value) {
  out.text("vec3i");
  out.put(static_cast<std::uint32_t>(sizeof value));
  for (const std::int32_t v : value) out.put(v);
}

void put_metadata(Bytes& out, const VdbMetadata& metadata) {
  out.put(static_cast<std::uint32_t>(metadata.size()));
  for (const auto& [name, value] : metadata) {
    out.text(name);
    std::visit([&](const auto& v) { put_value(out, v); }, value);
  }
}

bool diagonal(const std::array<double, 9>& m) {
  return m[1] == 0 && m[2] == 0 && m[3] == 0 && m[5] == 0 && m[6] == 0 && m[7] == 0;
}

double determinant(const std::array<double, 9>& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

// Writes the fields in the order of OpenVDB's Maps.h: scale, voxel size, inverse, its square, half of the inverse.
void put_transform(Bytes& out, const std::array<double, 9>& m, const std::array<double, 3>& translation) {
  if (diagonal(m)) {
    const std::array<double, 3> scale{m[0], m[4], m[8]};
    const bool uniform = scale[0] == scale[1] && scale[0] == scale[2];
    out.text(uniform ? "UniformScaleTranslateMap" : "ScaleTranslateMap");
    for (const double t : translation) out.put(t);
    for (const double s : scale) out.put(s);
    for (const double s : scale) out.put(std::abs(s));
    for (const double s : scale) out.put(1.0 / s);
    for (const double s : scale) out.put(1.0 / s / s);
    for (const double s : scale) out.put(0.5 / s);
    return;
  }
  out.text("AffineMap");  // row vectors: world = index * M
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t w = 0; w < 3; ++w) out.put(m[3 * w + axis]);
    out.put(0.0);
  }
  for (const double t : translation) out.put(t);
  out.put(1.0);
}

// Returns the digest as 8-4-4-4-12 hexadecimal digits.
std::string uuid(const Digest& content) {
  const std::string digits = content.hex();
  return cat(digits.substr(0, 8), '-', digits.substr(8, 4), '-', digits.substr(12, 4), '-', digits.substr(16, 4), '-',
             digits.substr(20));
}

}  // namespace

std::string vdb_head_bytes(const VdbHead& head) {
  Bytes out;
  out.put(kMagic);
  out.put(kFileVersion);
  out.put(kLibraryMajor);
  out.put(kLibraryMinor);
  out.put(std::uint8_t{1});  // grid offsets are present
  out.raw(uuid(head.content));
  put_metadata(out, {{"creator", head.creator}});
  out.put(std::uint32_t{1});  // number of grids
  out.text(head.name);
  out.text(head.half ? "Tree_float_5_4_3_HalfFloat" : "Tree_float_5_4_3");
  out.text({});  // not an instance of another grid
  out.put(static_cast<std::uint64_t>(out.size() + 3 * sizeof(std::uint64_t)));
  out.put(head.leaves_begin);
  out.put(head.end);
  out.put(head.compression);
  put_metadata(out, head.metadata);
  put_transform(out, head.matrix, head.translation);
  return out.take();
}

std::string vdb_transform_obstacle(const std::array<double, 9>& m, const std::array<double, 3>& translation) {
  if (!placeable({{{m[0], m[3], m[6]}, {m[1], m[4], m[7]}, {m[2], m[5], m[8]}}}, translation)) {
    return "its map is not finite or has a voxel size of 0";
  }
  constexpr double kLeastDeterminant = 3e-15;  // AffineMap::updateAcceleration
  if (!diagonal(m) && std::abs(determinant(m)) < kLeastDeterminant) {
    return cat("its rotated map has a determinant of ", determinant(m), ", and OpenVDB reads none below ",
               kLeastDeterminant, "; give larger voxels or no rotation");
  }
  return {};
}

}  // namespace weir
