// Planes of a push that are announced before their values come, as with values from a device.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compressor/push/pushed_volume.h"
#include "format/base/error.h"
#include "ingest/values/array_source.h"
#include "tests/compressor/support/push_calls.h"

namespace weir::expected_planes_test {
namespace {

class ExpectedPlanes : public test::PushCalls {};

TEST_F(ExpectedPlanes, MayBeFilledLaterInAnyPieces) {
  PushedVolume pushed(info_, options_, {}, files_);
  const auto end = [&] { return message(ErrorKind::usage, [&] { pushed.end(); }); };
  const auto stride = packed_stride(kExtent, ScalarType::float32);
  const auto fill = [&](std::int64_t z0, std::int64_t nz) { pushed.fill(z0, nz, values_.data(), stride); };
  pushed.expect(4, 16);
  EXPECT_EQ(message(ErrorKind::usage, [&] { pushed.slab(5, 1, values_.data()); }),
            "density: a slab of 1 plane from 5 on holds plane 5, given before; give each plane once");
  EXPECT_EQ(message(ErrorKind::usage, [&] { pushed.expect(18, 3); }),
            "density: a slab of 3 planes from 18 on is not in the volume, whose planes are 0 to 19");
  EXPECT_EQ(end(), "density: planes 0 to 3 of 20 never came; give the rest first");
  pushed.slab(0, 4, values_.data());
  EXPECT_EQ(end(), "density: 16 planes are still expected; end once their values have come");
  fill(5, 15);
  EXPECT_EQ(end(), "density: 1 plane is still expected; end once their values have come");
  fill(4, 1);
  EXPECT_EQ(end(), "no error");
  EXPECT_EQ(files_.names(), (std::vector<std::string>{"out.nvdb", "out.nvdb.json"}));
}

TEST_F(ExpectedPlanes, FailWhileTheyAreExpected_EndsThePush) {
  PushedVolume pushed(info_, options_, {}, files_);
  pushed.slab(0, 4, values_.data());
  pushed.expect(4, 16);
  pushed.fail(Error(ErrorKind::io, "copying a slab: the device is gone"));
  EXPECT_EQ(message(ErrorKind::io, [&] { pushed.slab(4, 1, values_.data()); }), "copying a slab: the device is gone");
  EXPECT_EQ(message(ErrorKind::io, [&] { pushed.end(); }), "copying a slab: the device is gone");
  EXPECT_EQ(files_.names(), std::vector<std::string>{});
}

}  // namespace
}  // namespace weir::expected_planes_test
