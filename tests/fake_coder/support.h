// Volumes and conversions for tests on the pretended device.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "tests/compressor/support/budget_of.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::fake_coder_test {

inline double waves(const Index3& i, int octaves) {
  const auto x = static_cast<double>(i.x), y = static_cast<double>(i.y), z = static_cast<double>(i.z);
  double sum = 0;
  double size = 1;
  for (int o = 1; o <= octaves; ++o, size *= 0.5) {
    const double f = 0.03 * std::pow(1.9, o);
    sum += size * std::sin(f * x + 1.3 * o) * std::cos(f * y - 0.7 * o) * std::sin(f * (z + 0.31 * x) + o);
  }
  return sum;
}

/// No axis has a length or a beginning that is a multiple of 8.
inline constexpr Box kOdd{{-3, 5, 130}, {98, 66, 181}};

inline test::MemoryVolume cloud(const Box& domain = kOdd) {
  return {domain, [](const Index3& i) { return static_cast<float>(std::max(0.0, waves(i, 5) - 0.15)); }};
}
inline test::MemoryVolume turbulence(const Box& domain = kOdd) {
  return {domain, [](const Index3& i) { return static_cast<float>(40 * waves(i, 7)); }};
}

/// Number of blocks whose values the pretended device has given to the host so far.
inline std::atomic<std::uint64_t>& values_copied() {
  static std::atomic<std::uint64_t> count{0};
  return count;
}

struct Result {
  std::vector<std::byte> file;
  std::vector<std::string> notices;
  Sidecar sidecar;
};

inline Result convert_by(BlockCoder* coder, VolumeSource& volume, ConversionOptions options) {
  test::CrashFileSystem files;
  options.output = "out.nvdb";
  options.encoding = Encoding::packed;
  options.memory = std::uint64_t{4} << 30U;
  if (options.threads == 0) options.threads = 2;
  Result result;
  ConversionControl control;
  control.notice = [&](const Message& line) { result.notices.push_back(line.text()); };
  control.coder = coder;
  result.sidecar = convert_volume(volume, options, control, files);
  result.file = files.take("out.nvdb");
  return result;
}

inline ConversionOptions with(const Budget& budget) {
  ConversionOptions options;
  options.budget = budget;
  return options;
}
/// A budget of each kind, by name.
struct NamedBudget {
  std::string name;
  Budget budget;
};
inline std::vector<NamedBudget> budgets() {
  Budget size;
  size.kind = Budget::Kind::size;
  size.bytes = 200'003;
  Budget lossless;
  lossless.kind = Budget::Kind::lossless;
  return {{"rate 4", budget_of(Budget::Kind::rate, 4)},
          {"rate 9", budget_of(Budget::Kind::rate, 9)},
          {"size", size},
          {"psnr 45", budget_of(Budget::Kind::psnr, 45)},
          {"psnr 80", budget_of(Budget::Kind::psnr, 80)},
          {"default", Budget{}},
          {"max-error", budget_of(Budget::Kind::max_error, 0.01)},
          {"lossless", lossless}};
}

}  // namespace weir::fake_coder_test
