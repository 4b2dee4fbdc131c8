// The files that `weir convert --overwrite` leaves if it is killed between the renames of its commit. The old and the
// new file have the same size and the same head checksum.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "format/sidecar/sidecar.h"
#include "tests/support/run_command.h"

namespace weir {

/// The old volume is noise. The new volume has the same planes in reverse order.
class KilledOverwrite {
 public:
  explicit KilledOverwrite(const TemporaryDirectory& directory)
      : source(directory / "noise_64x64x64_uint8.raw"), output(directory / "out.nvdb") {
    constexpr std::size_t kPlane = 64 * 64;
    std::string values(64 * kPlane, '\0');
    std::uint32_t state = 1;
    for (char& value : values) value = static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
    convert(values);
    old_volume = read_file(output);
    old_sidecar = read_file(sidecar);
    std::string reversed;
    for (std::size_t z = 64; z-- > 0;) reversed += values.substr(z * kPlane, kPlane);
    convert(reversed);
    new_volume = read_file(output);
    new_sidecar = read_file(sidecar);
    EXPECT_EQ(record(old_sidecar).bytes, record(new_sidecar).bytes);
    EXPECT_EQ(record(old_sidecar).head_checksum, record(new_sidecar).head_checksum);
    EXPECT_NE(record(old_sidecar).digest, record(new_sidecar).digest);
    write_file(output, old_volume);
    write_file(previous, old_sidecar);
    write_file(partial, new_volume);
  }

  /// Returns the command of the conversion that was killed, without --overwrite.
  std::vector<std::string> command() const {
    return {"convert", source, "-o", output, "--rate", "2", "--encoding", "fpn", "--progress", "never"};
  }

  std::string source;
  std::string output;
  std::string sidecar = sidecar_path(output);
  std::string previous = sidecar + ".previous";
  std::string partial = output + ".partial";
  std::string old_volume, old_sidecar;  ///< bytes of the files
  std::string new_volume, new_sidecar;

 private:
  static Sidecar::File record(const std::string& text) { return parse_sidecar(text, "sidecar").file; }

  void convert(const std::string& values) const {
    write_file(source, values);
    std::vector<std::string> overwriting = command();
    overwriting.emplace_back("--overwrite");
    const CommandResult made = run_weir(overwriting);
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }
};

}  // namespace weir
