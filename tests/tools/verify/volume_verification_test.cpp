#include "tools/verify/volume_verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "tests/tools/support/converted_volume.h"

namespace weir::volume_verification_test {
namespace {

using VolumeVerification = ConvertedVolume;

TEST_F(VolumeVerification, EveryPass_EndsWithAllOfItsBytes) {
  std::map<std::string, std::uint64_t> totals;
  std::map<std::string, std::uint64_t> done;
  std::string current;
  VerificationWatch watch;
  watch.pass_started = [&](const std::string& pass, std::uint64_t bytes) { totals[current = pass] = bytes; };
  watch.pass_advanced = [&](std::uint64_t bytes) { done[current] = std::max(done[current], bytes); };
  for (const VolumeCheck& check : verify_volume(volume_, watch)) EXPECT_TRUE(check.ok) << check.name;
  EXPECT_EQ(totals.at("digest"), std::filesystem::file_size(volume_));
  EXPECT_EQ(done, totals);
}

}  // namespace
}  // namespace weir::volume_verification_test
