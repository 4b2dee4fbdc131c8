#include "tests/support/block_volumes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

namespace weir::test {
namespace {

using Field = std::function<double(double, double, double)>;

BlockVolume sampled(std::string name, const Index3& extent, const Field& field) {
  BlockVolume volume{std::move(name), extent, {}};
  for (std::int64_t z = 0; z < extent.z; ++z) {
    for (std::int64_t y = 0; y < extent.y; ++y) {
      for (std::int64_t x = 0; x < extent.x; ++x) {
        volume.values.push_back(
            static_cast<float>(field(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z))));
      }
    }
  }
  return volume;
}

double waves(double x, double y, double z, int octaves) {
  double sum = 0;
  double size = 1;
  for (int o = 1; o <= octaves; ++o, size *= 0.55) {
    const double f = 0.07 * std::pow(1.9, o);
    sum += size * std::sin(f * x + 1.3 * o) * std::cos(f * y - 0.7 * o) * std::sin(f * (z + 0.31 * x) + o);
  }
  return sum;
}

BlockVolume mixed(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  BlockVolume volume{"mixed " + std::to_string(seed), {32, 32, 16}, std::vector<float>(32 * 32 * 16)};
  for (std::int64_t b = 0; b < 32; ++b) {
    const int exponent = static_cast<int>(std::floor(unit(random) * 60)) * (b % 4 == 0 ? 2 : 1);
    const double roughness = std::pow(2.0, 8 * unit(random) - 8);
    const double offset = b % 3 == 0 ? 0 : 4 * unit(random);
    for (std::int64_t i = 0; i < 512; ++i) {
      const Index3 in{i & 7, i >> 3 & 7, i >> 6};
      const Index3 at = Index3{b % 4, b / 4 % 4, b / 16} * 8 + in;
      double v = offset + std::sin(0.3 * static_cast<double>(in.x) + 0.2 * static_cast<double>(in.y * in.z)) +
                 roughness * unit(random);
      if (b % 5 == 0 && unit(random) > -0.4) v = 0;
      if (b % 7 == 0) v = -std::fabs(v);
      volume.values[static_cast<std::size_t>(linear_index(at, volume.extent))] =
          static_cast<float>(std::ldexp(v, exponent));
    }
  }
  return volume;
}

}  // namespace

std::vector<BlockVolume> block_volumes() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  const Index3 whole{32, 24, 16};
  const Index3 odd{29, 19, 13};
  std::vector<BlockVolume> all;
  all.push_back(
      sampled("cloud", odd, [](double x, double y, double z) { return std::max(0.0, waves(x, y, z, 4) - 0.1); }));
  all.push_back(sampled("turbulence", whole, [](double x, double y, double z) { return 30 * waves(x, y, z, 7); }));
  all.push_back(sampled("noise", odd, [&](double, double, double) { return normal(random); }));
  all.push_back(sampled("offset", whole, [](double x, double y, double z) { return 1e8 + 1e-3 * waves(x, y, z, 3); }));
  all.push_back(
      sampled("above one", whole, [](double x, double y, double z) { return 1.4 + 0.1 * waves(x, y, z, 3); }));
  all.push_back(
      sampled("smooth above one", whole, [](double x, double, double) { return 1.5 + 1e-4 * std::sin(0.1 * x); }));
  all.push_back(sampled("outlier", whole, [](double x, double y, double z) {
    return x == 9 && y == 9 && z == 9 ? 1e6 : 1e-3 * waves(x, y, z, 3);
  }));
  all.push_back(sampled("tiny", whole, [](double x, double y, double z) { return 1e-16 * waves(x, y, z, 3); }));
  all.push_back(sampled("denormal", whole, [](double x, double y, double z) { return 1e-41 * waves(x, y, z, 3); }));
  all.push_back(sampled("almost denormal", whole, [](double x, double, double) { return 1e-30 * x; }));
  all.push_back(sampled("huge", whole, [](double x, double y, double z) { return 9e29 * waves(x, y, z, 3); }));
  all.push_back(
      sampled("overflowing", whole, [](double x, double y, double z) { return (x + y + z) > 30 ? 3e38 : -3e38; }));
  all.push_back(sampled("whole numbers", odd, [](double x, double y, double z) { return std::floor(x * y / 3 + z); }));
  all.push_back(
      sampled("large whole numbers", odd, [&](double, double, double) { return std::floor(unit(random) * 1e9); }));
  all.push_back(sampled("constant", odd, [](double, double, double) { return 3.25; }));
  all.push_back(sampled("checkerboard", whole, [](double x, double y, double z) {
    return static_cast<int>(x + y + z) % 2 == 0 ? -1.0 : 1.0;
  }));
  all.push_back(sampled("plateau with spikes", whole, [](double x, double y, double z) {
    return static_cast<int>(x + 32 * y + 768 * z) % 301 == 5 ? 7.0 : 0.1;
  }));
  all.push_back(sampled("signed zeros", whole, [](double x, double y, double) { return x < y ? -0.0 : 0.0; }));
  all.push_back(sampled("not finite", whole, [](double x, double y, double z) {
    return x == 3    ? std::numeric_limits<double>::quiet_NaN()
           : y == 11 ? std::numeric_limits<double>::infinity()
                     : waves(x, y, z, 3);
  }));
  all.push_back(sampled("one voxel", {1, 1, 1}, [](double, double, double) { return 0.7; }));
  all.push_back(sampled("a row", {1, 1, 27}, [](double, double, double z) { return std::sin(z); }));
  return all;
}

std::vector<BlockVolume> mixed_volumes() {
  std::vector<BlockVolume> all;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) all.push_back(mixed(seed));
  return all;
}

bool BlockVolume::all_finite() const {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

BlockVolume block_volume(const std::string& name) {
  for (BlockVolume& volume : block_volumes()) {
    if (volume.name == name) return std::move(volume);
  }
  throw std::out_of_range("no volume " + name);
}

}  // namespace weir::test
