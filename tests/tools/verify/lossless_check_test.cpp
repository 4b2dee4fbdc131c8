#include "tools/verify/lossless_check.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/tools/support/converted_volume.h"

namespace weir::lossless_check_test {
namespace {

using LosslessCheck = ConvertedVolume;

// Returns the checks that fail after `change` was applied to the sidecar; "none made" if there are no checks.
std::string failed_of(const NvdbFile& file, Sidecar sidecar, const std::function<void(Sidecar&)>& change) {
  change(sidecar);
  const auto checks = check_lossless(take_census(file.grid(), {}), file.grid().background(), sidecar);
  if (checks.empty()) return "none made";
  std::string names;
  for (const VolumeCheck& check : checks) names += check.ok ? "" : check.name + '\n';
  return names;
}

TEST_F(LosslessCheck, FigureThatTheValuesContradict_Fails) {
  const NvdbFile file = open();
  const auto failed = [&](const std::function<void(Sidecar&)>& change) { return failed_of(file, sidecar(), change); };
  EXPECT_EQ(failed([](Sidecar&) {}), "");
  EXPECT_EQ(failed([](Sidecar& s) { s.value_range[1] += 1; }), "sidecar value_range of a lossless file\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.value_range[0] -= 1; }), "sidecar value_range of a lossless file\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.zeros->count; }), "sidecar zeros.count\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.zeros->lost = 1; }), "sidecar zeros.lost of a lossless file\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.background.share /= 2; }), "sidecar background.share of a lossless file\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.nonfinite = {1, "keep"}; }), "sidecar nonfinite.count\n");
}

TEST_F(LosslessCheck, ValuesThatAreNotTheSources_AreNotCompared) {
  const NvdbFile file = open();
  const auto failed = [&](const std::function<void(Sidecar&)>& change) { return failed_of(file, sidecar(), change); };
  EXPECT_EQ(failed([](Sidecar& s) { s.error.lossless = false; }), "none made");
  EXPECT_EQ(failed([](Sidecar& s) { s.nonfinite = {1, "background"}; }), "none made");
  EXPECT_EQ(failed([](Sidecar& s) { s.missing.count = 1, s.missing.policy = "nan"; }), "none made");
  EXPECT_EQ(failed([](Sidecar& s) { s.zeros.reset(); }), "none made") << "of weir 0.1";
  EXPECT_EQ(failed([](Sidecar& s) { s.background = {0, "sampled-mode", 0.1}; }), "") << "a share of samples";
}

TEST_F(LosslessCheck, RightFiles_Pass) {
  for (const std::string kind : {"cloud", "turbulence", "constant", "negative-zero", "some-nan", "nan"}) {
    const std::string raw = directory_ / (kind + "_41x35x19_float32.raw");
    ASSERT_EQ(run_weir({"sample", kind, "-o", raw}).exit_code, 0);
    for (const std::string encoding : {"float", "packed"}) {
      for (const std::string roi : {"0:41,0:35,0:19", "3:40,9:33,2:18"}) {
        const std::string output = directory_ / "r.nvdb";
        const auto made = run_weir({"convert", raw, "-o", output, "--lossless", "--encoding", encoding, "--roi", roi,
                                    "--nonfinite", "keep", "--overwrite"});
        ASSERT_EQ(made.exit_code, 0) << made.err;
        const NvdbFile file(output);
        EXPECT_EQ(failed_of(file, read_sidecar(sidecar_path(output)), [](Sidecar&) {}), "") << kind << encoding << roi;
        EXPECT_EQ(run_weir({"verify", output}).exit_code, 0) << kind << encoding << roi;
      }
    }
  }
}

}  // namespace
}  // namespace weir::lossless_check_test
