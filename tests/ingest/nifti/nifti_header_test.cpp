#include "ingest/nifti/nifti_header.h"

#include <cmath>
#include <limits>

#include "tests/ingest/support/nifti_file.h"
#include "tests/ingest/support/scratch.h"

namespace weir::nifti_header_test {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

NiftiHeader parse(const NiftiBytes& header) { return parse_nifti_header(bytes_of(header.bytes()), "a.nii"); }

std::string refusal(const NiftiBytes& header) {
  return message_of_error(ErrorKind::input, [&] { parse(header); });
}

TEST(NiftiHeader, ParsesMinimalHeadersOfBothVersionsAndByteOrders) {
  for (const int version : {1, 2}) {
    for (const bool big : {false, true}) {
      const NiftiHeader header = parse(NiftiBytes(version, big));
      EXPECT_EQ(header.big_endian, big);
      EXPECT_FALSE(header.pair);
      EXPECT_EQ(header.extents, (std::vector<std::int64_t>{4, 3, 2}));
      EXPECT_EQ(header.type, ScalarType::uint8);
      EXPECT_EQ(header.values_offset, version == 1 ? 352 : 544);
      EXPECT_EQ(header.slope, 1);
      EXPECT_EQ(header.intercept, 0);
      EXPECT_EQ(header.spacing, (Vector3{1, 1, 1}));
      EXPECT_EQ(header.first, (Vector3{0, 0, 0}));
      EXPECT_EQ(header.length_unit, "");
    }
  }
}

TEST(NiftiHeader, TakesSpacingScaleAndUnit) {
  NiftiBytes first(1);
  first.set_all<float>(76, {-1, 0.5F, -0.25F, 2}).set<float>(112, 0.5F).set<float>(116, -7).set_text(123, "\x0A");
  NiftiBytes second(2, true);
  second.set_all<double>(104, {-1, 0.5, -0.25, 2})
      .set<double>(176, 0.5)
      .set<double>(184, -7)
      .set<std::int32_t>(500, 10);
  for (const NiftiBytes& bytes : {first, second}) {
    const NiftiHeader header = parse(bytes);
    EXPECT_EQ(header.spacing, (Vector3{0.5, 0.25, 2}));
    EXPECT_EQ(header.slope, 0.5);
    EXPECT_EQ(header.intercept, -7);
    EXPECT_EQ(header.length_unit, "mm");
  }
}

TEST(NiftiHeader, InvalidSpacingIsOneAndInvalidScaleIsIgnored) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const NiftiHeader header = parse(NiftiBytes(1).set_all<float>(76, {1, 0, nan, 3}).set<float>(112, nan));
  EXPECT_EQ(header.spacing, (Vector3{1, 1, 3}));
  EXPECT_EQ(header.slope, 1);
  // An intercept without a slope means nothing.
  EXPECT_EQ(parse(NiftiBytes(1).set<float>(116, 5)).intercept, 0);
  EXPECT_EQ(refusal(NiftiBytes(1).set<float>(112, 2).set<float>(116, nan)),
            "a.nii: scl_inter at byte 116 is nan; with scl_slope 2 it must be finite");
  EXPECT_EQ(refusal(NiftiBytes(1).set<float>(112, std::numeric_limits<float>::infinity())),
            "a.nii: scl_slope at byte 112 is inf; it must be finite");
}

TEST(NiftiHeader, TheSformRulesOverTheQform) {
  NiftiBytes first(1);
  first.set<std::int16_t>(252, 1).set<std::int16_t>(254, 2).set_all<float>(268, {7, 8, 9});
  first.set_all<float>(280, {-2, 0, 0, 90, 0, 3, 0.5F, -126, 0, 0, 4, -72});
  NiftiBytes second(2);
  second.set<std::int32_t>(344, 1).set<std::int32_t>(348, 2).set_all<double>(376, {7, 8, 9});
  second.set_all<double>(400, {-2, 0, 0, 90, 0, 3, 0.5, -126, 0, 0, 4, -72});
  for (const NiftiBytes& bytes : {first, second}) {
    const NiftiHeader header = parse(bytes);
    EXPECT_TRUE(header.steps_rule);
    EXPECT_EQ(header.steps[0], (Vector3{-2, 0, 0}));
    EXPECT_EQ(header.steps[1], (Vector3{0, 3, 0}));
    EXPECT_EQ(header.steps[2], (Vector3{0, 0.5, 4}));
    EXPECT_EQ(header.first, (Vector3{90, -126, -72}));
  }
}

TEST(NiftiHeader, TheQformTurnsAndFlips) {
  NiftiBytes bytes(1);
  // Half a turn about y reverses x and z; qfac -1 then reverses z once more.
  bytes.set<std::int16_t>(252, 1).set_all<float>(256, {0, 1, 0}).set_all<float>(268, {7, 8, 9});
  bytes.set_all<float>(76, {-1, 2, 3, 4});
  const NiftiHeader header = parse(bytes);
  EXPECT_FALSE(header.steps_rule);
  EXPECT_EQ(header.steps[0], (Vector3{-2, 0, 0}));
  EXPECT_EQ(header.steps[1], (Vector3{0, 3, 0}));
  EXPECT_EQ(header.steps[2], (Vector3{0, 0, 4}));
  EXPECT_EQ(header.first, (Vector3{7, 8, 9}));
  // A quarter turn about z: the image's x runs along the world's y, and its y against the world's x.
  const auto half = static_cast<float>(std::sqrt(0.5));
  bytes.set_all<float>(256, {0, 0, half}).set<float>(76, 1);
  EXPECT_NEAR(parse(bytes).steps[0][1], 2, 1e-6);
  EXPECT_NEAR(parse(bytes).steps[1][0], -3, 1e-6);
  EXPECT_NEAR(parse(bytes).steps[2][2], 4, 1e-6);
}

TEST(NiftiHeader, SformThatIsNoPlace_GivesWayToTheQform_AndThatToPixdim) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> whole{-2, 0, 0, 90, 0, 3, 0.5F, -126, 0, 0, 4, -72};
  std::vector<std::vector<float>> wrong(4, whole);
  wrong[0] = std::vector<float>(12, 0);
  wrong[1][5] = 0;         // the step along y is zero
  wrong[2][10] = nan;      // the step along z is not finite
  wrong[3][3] = infinity;  // the position of the first voxel is not finite
  for (const std::vector<float>& sform : wrong) {
    NiftiBytes bytes(1);
    bytes.set<std::int16_t>(252, 1).set<std::int16_t>(254, 2).set_all<float>(76, {1, 2, 3, 4});
    bytes.set_all<float>(256, {0, 1, 0}).set_all<float>(268, {7, 8, 9}).set_all<float>(280, sform);
    const NiftiHeader turned = parse(bytes);  // the qform is half a turn about y
    EXPECT_FALSE(turned.steps_rule);
    EXPECT_EQ(turned.steps, (std::array<Vector3, 3>{{{-2, 0, 0}, {0, 3, 0}, {0, 0, -4}}}));
    EXPECT_EQ(turned.first, (Vector3{7, 8, 9}));
    EXPECT_EQ(turned.placement_note,
              "its sform has a column that is zero or not finite; the place is that of the qform");
    bytes.set<float>(260, nan);
    const NiftiHeader plain = parse(bytes);
    EXPECT_FALSE(plain.steps_rule);
    EXPECT_EQ(plain.steps, (std::array<Vector3, 3>{{{2, 0, 0}, {0, 3, 0}, {0, 0, 4}}}));
    EXPECT_EQ(plain.first, (Vector3{0, 0, 0}));
    EXPECT_EQ(plain.placement_note, "neither its sform nor its qform can be used; the place is that of pixdim");
    bytes.set<std::int16_t>(252, 0);
    EXPECT_EQ(parse(bytes).placement_note,
              "its sform has a column that is zero or not finite; the place is that of pixdim");
    bytes.set<std::int16_t>(252, 1).set<std::int16_t>(254, 0);
    EXPECT_EQ(parse(bytes).placement_note, "its qform is not finite; the place is that of pixdim");
    EXPECT_EQ(parse(bytes).steps, plain.steps);
    bytes.set_all<float>(280, whole).set<std::int16_t>(254, 1);
    EXPECT_TRUE(parse(bytes).steps_rule);
    EXPECT_EQ(parse(bytes).placement_note, "") << "the qform does not count";
  }
  // The sform's column for an axis that the image does not have may be zero.
  NiftiBytes flat(2);
  flat.set_all<std::int64_t>(16, {2, 4, 3}).set<std::int32_t>(348, 1);
  flat.set_all<double>(400, {1, 0, 0, 5, 0, 2, 0, 6, 0, 0, 0, 7});
  EXPECT_TRUE(parse(flat).steps_rule);
  EXPECT_EQ(parse(flat).placement_note, "");
}

TEST(NiftiHeader, AxisAfterTheThirdOfZeroPositions_HasOne) {
  EXPECT_EQ(parse(NiftiBytes(1).set_all<std::int16_t>(40, {4, 4, 3, 2, 0})).extents,
            (std::vector<std::int64_t>{4, 3, 2, 1}));
  EXPECT_EQ(parse(NiftiBytes(2, true).set_all<std::int64_t>(16, {5, 4, 3, 1, 0, 2})).extents,
            (std::vector<std::int64_t>{4, 3, 1, 1, 2}));
  EXPECT_EQ(refusal(NiftiBytes(1).set_all<std::int16_t>(40, {4, 4, 3, 2, -1})),
            "a.nii: dim[4] at byte 48 is -1; it must be at least 1");
}

TEST(NiftiHeader, ParsesSupportedTypesAndNamesOthers) {
  const std::vector<std::pair<std::int16_t, ScalarType>> types{
      {2, ScalarType::uint8},    {4, ScalarType::int16},    {8, ScalarType::int32},    {16, ScalarType::float32},
      {64, ScalarType::float64}, {256, ScalarType::int8},   {512, ScalarType::uint16}, {768, ScalarType::uint32},
      {1024, ScalarType::int64}, {1280, ScalarType::uint64}};
  for (const auto& [code, type] : types) {
    EXPECT_EQ(parse(NiftiBytes(1, true).set(70, code)).type, type);
    EXPECT_EQ(parse(NiftiBytes(2).set(12, code)).type, type);
  }
  const std::string readable = "; integers of 8 to 64 bits, float32 and float64 can be read";
  EXPECT_EQ(refusal(NiftiBytes(1).set<std::int16_t>(70, 128)), "a.nii: datatype at byte 70 is 128 (RGB24)" + readable);
  EXPECT_EQ(refusal(NiftiBytes(2).set<std::int16_t>(12, 32)),
            "a.nii: datatype at byte 12 is 32 (complex64)" + readable);
  EXPECT_EQ(refusal(NiftiBytes(1).set<std::int16_t>(70, 3)), "a.nii: datatype at byte 70 is 3" + readable);
}

TEST(NiftiHeader, BitpixOfAnotherDatatype_IsRefused_UnlessItIsZero) {
  EXPECT_EQ(refusal(NiftiBytes(1).set<std::int16_t>(72, 16)),
            "a.nii: bitpix at byte 72 is 16; datatype 2 (uint8) has 8; correct the one of the two that is wrong");
  EXPECT_EQ(refusal(NiftiBytes(2, true).set<std::int16_t>(12, 64).set<std::int16_t>(14, 32)),
            "a.nii: bitpix at byte 14 is 32; datatype 64 (float64) has 64; correct the one of the two that is wrong");
  EXPECT_EQ(parse(NiftiBytes(1).set<std::int16_t>(70, 4).set<std::int16_t>(72, 16)).type, ScalarType::int16);
  EXPECT_EQ(parse(NiftiBytes(1).set<std::int16_t>(70, 4).set<std::int16_t>(72, 0)).type, ScalarType::int16);
}

TEST(NiftiHeader, PairsHaveValuesAnywhere) {
  const NiftiHeader header = parse(NiftiBytes(1).set_text(344, "ni1").set<float>(108, 0));
  EXPECT_TRUE(header.pair);
  EXPECT_EQ(header.values_offset, 0);
  EXPECT_TRUE(parse(NiftiBytes(2).set_text(4, "ni2").set<std::int64_t>(168, 16)).pair);
}

TEST(NiftiHeader, RefusesInvalidHeaders) {
  EXPECT_EQ(refusal(NiftiBytes(1).set_text(344, "abc")),
            "a.nii: magic at byte 344 is 'abc?'; it must be n+1 or ni1; Analyze 7.5 files, which have none, cannot be "
            "read");
  EXPECT_EQ(refusal(NiftiBytes(2).set_text(8, "\n")),
            "a.nii: magic at byte 4 is 'n+2" + std::string(5, '?') +
                "'; it must be n+2 or ni2 and its line ends, which copying as text changes");
  EXPECT_EQ(refusal(NiftiBytes(1).set<std::int16_t>(40, 0)), "a.nii: dim[0] at byte 40 is 0; it must be 1 to 7");
  EXPECT_EQ(refusal(NiftiBytes(1).set<std::int16_t>(40, 8)), "a.nii: dim[0] at byte 40 is 8; it must be 1 to 7");
  EXPECT_EQ(refusal(NiftiBytes(1).set<std::int16_t>(44, -3)), "a.nii: dim[2] at byte 44 is -3; it must be at least 1");
  EXPECT_EQ(refusal(NiftiBytes(2).set<std::int64_t>(40, 0)), "a.nii: dim[3] at byte 40 is 0; it must be at least 1");
  const std::string least = "; it must be a whole number, at least 352";
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<std::pair<float, std::string>> offsets{
      {0.0F, "0"}, {352.5F, "352.5"}, {-1.0F, "-1"}, {1e30F, "1.00000002e+30"}, {infinity, "inf"}};
  for (const auto& [offset, text] : offsets) {
    EXPECT_EQ(refusal(NiftiBytes(1).set(108, offset)), "a.nii: vox_offset at byte 108 is " + text + least);
  }
  EXPECT_EQ(refusal(NiftiBytes(2).set<std::int64_t>(168, -1)),
            "a.nii: vox_offset at byte 168 is -1; it must be a whole number, at least 544");
}

TEST(NiftiHeader, CutAtAnyByteItIsRefused) {
  for (const int version : {1, 2}) {
    const std::string whole = NiftiBytes(version).bytes();
    const std::size_t header = version == 1 ? 348 : 540;
    for (std::size_t size = 0; size < header; ++size) {
      const std::string cut = whole.substr(0, size);
      const std::string message =
          message_of_error(ErrorKind::input, [&] { parse_nifti_header(bytes_of(cut), "a.nii"); });
      EXPECT_EQ(message, size < 4 ? "a.nii: is no NIfTI file: its first four bytes are neither 348 nor 540"
                                  : "a.nii: ends after " + std::to_string(size) + " bytes, its header alone has " +
                                        std::to_string(header));
    }
    EXPECT_TRUE(begins_like_nifti(bytes_of(whole)));
  }
}

}  // namespace
}  // namespace weir::nifti_header_test
