#include "compressor/leaf/twin_sums.h"

#include <array>
#include <cstring>

#include "compressor/leaf/leaf_repeats.h"
#include "format/base/index.h"
#include "format/base/simd.h"

namespace weir {
namespace {

// Sums 16 lanes pairwise. Each lane of `lanes` stands for two equal lanes, eight apart, which are added first.
double sum_of_twins(const Floats8& lanes) {
  const Floats8 doubled = lanes + lanes;
  std::array<float, 8> all;
  std::memcpy(all.data(), &doubled, sizeof all);
  for (std::size_t width = all.size() / 2; width > 0; width /= 2) {
    for (std::size_t i = 0; i < width; ++i) all[i] += all[i + width];
  }
  return static_cast<double>(all[0]);
}

}  // namespace

WEIR_SIMD double twin_deviate(const float* values, std::size_t planes, float mean, float scale, float* deviations) {
  Floats8 squares{};
  for (std::size_t z = 0; z < kLeafVoxels; z += planes * kTwinPlane) {
    std::array<Floats8, kTwins> terms;
    for (std::size_t k = 0; k < kTwins; ++k) {
      Floats8 v;
      std::memcpy(&v, values + z + kTwinStep * k, sizeof v);
      const Floats8 d = (v - mean) * scale;
      std::memcpy(deviations + z + kTwinStep * k, &d, sizeof d);
      terms[k] = d * d;
    }
    for (std::size_t n = 0; n < planes; ++n) {
      for (std::size_t k = 0; k < kTwins; ++k) squares += terms[k];
    }
  }
  return sum_of_twins(squares);
}

WEIR_SIMD CodeSums twin_assign(const float* values, const float* deviations, std::size_t planes,
                               const CodeLevels& levels) {
  const CodeLevels l = levels;
  Floats8 codes{};
  Floats8 code_squares{};
  Floats8 code_values{};
  for (std::size_t z = 0; z < kLeafVoxels; z += planes * kTwinPlane) {
    std::array<Floats8, kTwins> code;
    std::array<Floats8, kTwins> squared;
    std::array<Floats8, kTwins> times_value;
    for (std::size_t k = 0; k < kTwins; ++k) {
      Floats8 v;
      Floats8 d;
      std::memcpy(&v, values + z + kTwinStep * k, sizeof v);
      std::memcpy(&d, deviations + z + kTwinStep * k, sizeof d);
      nearest_code(v, l, code[k]);
      squared[k] = code[k] * code[k];
      times_value[k] = code[k] * d;
    }
    for (std::size_t n = 0; n < planes; ++n) {
      for (std::size_t k = 0; k < kTwins; ++k) {
        codes += code[k];
        code_squares += squared[k];
        code_values += times_value[k];
      }
    }
  }
  return {0, sum_of_twins(codes), sum_of_twins(code_squares), sum_of_twins(code_values)};
}

WEIR_SIMD double twin_measure(const float* values, std::size_t planes, const CodeLevels& levels, float scale) {
  const CodeLevels l = levels;
  Floats8 squares{};
  for (std::size_t z = 0; z < kLeafVoxels; z += planes * kTwinPlane) {
    std::array<Floats8, kTwins> terms;
    for (std::size_t k = 0; k < kTwins; ++k) {
      Floats8 v;
      Floats8 code;
      std::memcpy(&v, values + z + kTwinStep * k, sizeof v);
      nearest_code(v, l, code);
      const Floats8 error = (v - (code * l.quantum + l.minimum)) * scale;
      terms[k] = error * error;
    }
    for (std::size_t n = 0; n < planes; ++n) {
      for (std::size_t k = 0; k < kTwins; ++k) squares += terms[k];
    }
  }
  return sum_of_twins(squares);
}

}  // namespace weir
