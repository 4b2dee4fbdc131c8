#include "tests/compressor/support/hard_cases.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <limits>

#include "ingest/synthetic/synthetic.h"

namespace weir::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

HardCase synthetic(const std::string& name, const std::string& kind, const Index3& extent) {
  return {name, [kind, extent] {
            const auto source = open_synthetic(kind, {extent, 5});
            return MemoryVolume(*source);
          }};
}

HardCase field(const std::string& name, const Box& domain, const std::function<float(const Index3&)>& value) {
  return {name, [domain, value] { return MemoryVolume(domain, value); }};
}

bool all_finite(const MemoryVolume& volume) {
  return std::all_of(volume.values().begin(), volume.values().end(), [](float v) { return std::isfinite(v); });
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const HardCase& c) { return out << c.name; }

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> cases;
  for (const SyntheticKind& kind : synthetic_kinds()) {
    std::string name;
    bool upper = true;
    for (const char c : kind.name) {
      if (c != '-') name += upper ? static_cast<char>(std::toupper(c)) : c;
      upper = c == '-';
    }
    cases.push_back(synthetic(name, std::string(kind.name), {45, 30, 25}));
  }
  cases.push_back(synthetic("CloudOfManyRegions", "cloud", {150, 140, 20}));
  cases.push_back(synthetic("HotVoxelOfManyRegions", "hot-voxel", {270, 140, 20}));
  cases.push_back(synthetic("OneVoxel", "noise", {1, 1, 1}));
  cases.push_back(synthetic("AlongX", "noise", {300, 1, 1}));
  cases.push_back(synthetic("AlongY", "noise", {1, 300, 1}));
  cases.push_back(synthetic("AlongZ", "noise", {1, 1, 300}));
  cases.push_back(field("OneNaN", {{0, 0, 0}, {1, 1, 1}}, [](const Index3&) { return kNaN; }));
  cases.push_back(
      field("AllInfinite", {{0, 0, 0}, {20, 9, 9}}, [](const Index3& i) { return i.x < 10 ? kInf : -kInf; }));
  cases.push_back(field("RegionOfNaN", {{0, 0, 0}, {300, 20, 20}},
                        [](const Index3& i) { return i.x >= 128 && i.x < 256 ? kNaN : static_cast<float>(i.x % 7); }));
  cases.push_back(field("SignedNaNPayloads", {{0, 0, 0}, {24, 16, 16}}, [](const Index3& i) {
    return i.x % 5 == 0 ? std::bit_cast<float>(0xFFC12345U + static_cast<std::uint32_t>(i.y)) : 2.0F;
  }));
  cases.push_back(field("LeavesOf511EqualValues", {{-8, 0, 0}, {40, 24, 24}}, [](const Index3& i) {
    return (i.x & 7) == 3 && i.y % 8 == 4 && i.z % 8 == 5 ? 1.0F + 0x1p-23F : 1.0F;
  }));
  cases.push_back(field("NegativeZeroRegions", {{0, 0, 0}, {400, 9, 9}}, [](const Index3& i) {
    return i.x < 128 || i.x >= 384 ? 1.0F : i.x < 256 ? -0.0F : i.y < 5 ? -0.0F : 0.0F;
  }));
  cases.push_back(field("UniformRegionsBelowZero", {{-300, -9, -9}, {-1, 0, 0}},
                        [](const Index3& i) { return i.x < -128 ? -7.5F : static_cast<float>(i.z); }));
  cases.push_back(field("LargestFloats", {{0, 0, 0}, {30, 10, 10}}, [](const Index3& i) {
    const float most = std::numeric_limits<float>::max();
    return i.x % 3 == 0 ? most : i.x % 3 == 1 ? -most : 0x1p-149F;
  }));
  cases.push_back(field("MultiplesOfALargeStepAndOneTinyValue", {{0, 0, 0}, {40, 17, 9}}, [](const Index3& i) {
    return i.x % 8 == 5 && i.y % 8 == 3 && i.z == 2 ? 0x1p-80F : static_cast<float>((i.x * i.y + i.z) % 5) * 0x1p98F;
  }));
  return cases;
}

std::vector<NonFinitePolicy> policies_of(const MemoryVolume& volume) {
  if (all_finite(volume)) return {NonFinitePolicy::error};
  return {NonFinitePolicy::background, NonFinitePolicy::keep};
}

}  // namespace weir::test
