#include "tests/compressor/support/converted.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <regex>

#include "format/base/error.h"
#include "tests/compressor/support/crash_file_system.h"

namespace weir::test {

Converted convert(VolumeSource& volume, ConversionOptions options) {
  CrashFileSystem files;
  options.output = "out.nvdb";
  if (options.memory == ConversionOptions{}.memory) options.memory = std::uint64_t{4} << 30U;
  if (options.threads == 0) options.threads = 2;
  Converted converted;
  ConversionControl control;
  control.notice = [&](const Message& line) { converted.notices.push_back(line.text()); };
  control.planned = [&](std::uint64_t /*bytes*/) { ++converted.files_made; };
  converted.sidecar = convert_volume(volume, options, control, files);
  EXPECT_EQ(files.names(), (std::vector<std::string>{"out.nvdb", "out.nvdb.json"}));
  converted.file = files.take("out.nvdb");
  EXPECT_EQ(converted.file.size(), converted.sidecar.file.bytes);
  return converted;
}

Converted convert_to(VolumeSource& volume, ConversionOptions options, std::uint64_t file_bytes) {
  options.budget.kind = Budget::Kind::size;
  options.budget.bytes = file_bytes;
  return convert(volume, options);
}

std::uint64_t minimum_size(VolumeSource& volume, ConversionOptions options) {
  try {
    convert_to(volume, options, 1);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::budget);
    const std::string message = error.what();
    std::smatch match;
    static const std::regex form(
        "out\\.nvdb: 1 bytes asked, the smallest tree for this volume takes ([0-9]+); ask for --size ([0-9]+) or more");
    if (std::regex_match(message, match, form) && match[1] == match[2]) return std::stoull(match[1]);
    ADD_FAILURE() << message;
    return 0;
  }
  ADD_FAILURE() << "a file of one byte";
  return 0;
}

std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }

float expected_tile(const MemoryVolume& volume, const Box& box, FillMode fill, float background) {
  if (fill == FillMode::background) return background;
  long double sum = 0;
  std::int64_t finite = 0;
  bool one_value = true;
  float first = 0;
  for (const float v : volume.in(box)) {
    if (!std::isfinite(v)) continue;
    if (finite == 0) first = v;
    one_value = one_value && bits_of(first) == bits_of(v);
    sum += static_cast<long double>(v);
    ++finite;
  }
  if (finite == 0) return background;
  return one_value ? first : static_cast<float>(sum / static_cast<long double>(finite));
}

}  // namespace weir::test
