// Surveys rows of blocks of a volume that lies on the device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "format/base/error.h"
#include "gpu/cuda/encode/resident_volume.h"
#include "gpu/cuda/runtime/current_device.h"
#include "gpu/cuda/runtime/device_array.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/support/row_survey.h"

namespace weir::resident_rows_test {
namespace {

TEST(ResidentVolume, RowsOfBlocksAreSurveyedAsInABox) {
  WEIR_NEEDS_DEVICE();
  const KeptDevice kept(0);  // an earlier test may have left another device current
  const Box voxels{{-3, 5, 130}, {98, 66, 194}};
  std::vector<float> values(static_cast<std::size_t>(voxels.voxels()));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::max(0.0F, std::sin(0.01F * static_cast<float>(i)));
  const DeviceArray<float> on_device(values);
  const auto resident =
      make_resident_volume(0, on_device.data(), voxels, [](const Error& error) { ADD_FAILURE() << error.what(); });
  test::expect_rows_surveyed_as_in_a_box(*resident);
}

}  // namespace
}  // namespace weir::resident_rows_test
