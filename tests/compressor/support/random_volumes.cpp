#include "tests/compressor/support/random_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

#include "format/base/text.h"

namespace weir::test {
namespace {

using Engine = std::mt19937_64;

double uniform(Engine& random) { return std::ldexp(static_cast<double>(random() >> 11U), -53); }

double normal(Engine& random) {
  return std::sqrt(-2 * std::log(1 - uniform(random))) * std::cos(2 * M_PI * uniform(random));
}

struct Kind {
  const char* name;
  /// Draws the value at `i`. `shape`, from 0 to 1, is drawn once per volume.
  double (*draw)(Engine& random, double shape, const Index3& i);
};

constexpr std::array<Kind, 10> kKinds{{
    {"pareto", [](Engine& r, double s, const Index3&) { return std::pow(1 - uniform(r), -1 / (0.3 + 2 * s)); }},
    {"cauchy", [](Engine& r, double s, const Index3&) { return s * std::tan(M_PI * (uniform(r) - 0.5)); }},
    {"lognormal", [](Engine& r, double s, const Index3&) { return std::exp((1 + 5 * s) * normal(r)); }},
    {"spikes", [](Engine& r, double s,
                  const Index3&) { return (uniform(r) < std::pow(10, -2 - 3 * s) ? 6e5 : 0) + 1e-3 * uniform(r); }},
    {"tall spikes",
     [](Engine& r, double s, const Index3&) {
       return (uniform(r) < std::pow(10, -1 - 3 * s) ? 1e9 * uniform(r) : 0) + 1e-6 * normal(r);
     }},
    {"sparse", [](Engine& r, double s, const Index3&) { return uniform(r) < 0.3 * s ? normal(r) : 0; }},
    {"near a lattice", [](Engine& r, double s,
                          const Index3&) { return std::floor(256 * uniform(r)) + std::pow(10, -6 * s) * normal(r); }},
    {"few beside a lattice",
     [](Engine& r, double s, const Index3&) {
       return std::floor(std::exp2(8 * s) * uniform(r)) + (uniform(r) < 3e-3 ? std::pow(10, -6 * uniform(r)) : 0);
     }},
    {"smooth",
     [](Engine& r, double s, const Index3& i) {
       const double at = 0.05 * static_cast<double>(i.x) + 0.08 * static_cast<double>(i.y * i.z) / 16;
       return std::sin(at) + std::pow(10, -1 - 4 * s) * normal(r);
     }},
    {"uniform", [](Engine& r, double, const Index3&) { return uniform(r); }},
}};

}  // namespace

RandomVolume random_volume(std::uint64_t seed, std::int64_t most) {
  Engine random(seed);
  const Kind& kind = kKinds[seed % kKinds.size()];
  const auto side = [&] { return 16 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most - 15)); };
  const Index3 extent{side(), side(), side()};
  const double shape = uniform(random);
  const double quiet = uniform(random) < 0.5 ? uniform(random) : 1;  // share of the volume with values other than 0
  std::vector<float> values(static_cast<std::size_t>(volume(extent)));
  for (std::size_t n = 0; n < values.size(); ++n) {
    const Index3 i = index_at(static_cast<std::int64_t>(n), extent);
    const double value = kind.draw(random, shape, i);
    const bool holds = static_cast<double>(i.z) <= quiet * static_cast<double>(extent.z);
    values[n] = holds ? static_cast<float>(std::clamp(value, -1e30, 1e30)) : 0.0F;
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double range = static_cast<double>(*high) - static_cast<double>(*low);
  return {cat(kind.name, " ", extent.x, "x", extent.y, "x", extent.z, " of seed ", seed),
          MemoryVolume({{0, 0, 0}, extent}, std::move(values)), range};
}

std::uint64_t property_volumes(std::uint64_t ordinary) {
  const char* const asked = std::getenv("WEIR_PROPERTY_VOLUMES");
  return asked == nullptr ? ordinary : std::stoull(asked);
}

}  // namespace weir::test
