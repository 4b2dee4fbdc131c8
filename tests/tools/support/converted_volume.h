// A small volume made by the real `weir convert`, for tests of code that reads volumes.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/read_sidecar.h"
#include "format/sidecar/sidecar.h"
#include "tests/support/run_command.h"

namespace weir {

// 40 x 30 x 20 voxels, half of them zero, converted to float leaves of a size that has leaves, tiles and padding.
class ConvertedVolume : public testing::Test {
 protected:
  ConvertedVolume() {
    std::vector<float> values;
    for (int i = 0; i < 40 * 30 * 20; ++i) values.push_back(i % 40 < 20 ? 0.0F : static_cast<float>(i % 997) * 0.25F);
    std::string bytes(values.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    write_file(directory_.path() / "v_40x30x20_float32.raw", bytes);
    const auto made = run_weir(
        {"convert", directory_ / "v_40x30x20_float32.raw", "-o", volume_, "--size", "450001", "--encoding", "float"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }

  NvdbFile open() const { return NvdbFile(volume_); }
  Sidecar sidecar() const { return read_sidecar(sidecar_path(volume_)); }

  TemporaryDirectory directory_;
  std::string volume_ = directory_ / "v.nvdb";
};

}  // namespace weir
