// Tests what weir view refuses for lack of memory before the page is served.
#include "tools/view/memory_check.h"

#include <gtest/gtest.h>

#include <fstream>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_sample.h"
#include "tests/tools/support/converted_volume.h"

namespace weir::memory_check_test {
namespace {

constexpr std::uint64_t kKiB = 1024;

// A packed file, which takes 519.2 KiB, and volume_, which takes 288.1 KiB.
class MemoryCheck : public ConvertedVolume {
 protected:
  MemoryCheck() {
    const test::PackedFile made = test::PackedSample::build();
    std::ofstream(large_, std::ios::binary)
        .write(reinterpret_cast<const char*>(made.file.data()), static_cast<std::streamsize>(made.file.size()));
  }

  static void check(const std::vector<std::string>& steps, const std::vector<std::string>& against,
                    const VoxelMemory& memory) {
    ViewedFiles files;
    files.steps = steps;
    files.against = against;
    require_memory(files, memory, [](const std::string& path) { return path; });
  }
  static std::string refusal(const std::vector<std::string>& steps, const std::vector<std::string>& against,
                             const VoxelMemory& memory) {
    return message_of_error(ErrorKind::usage, [&] { check(steps, against, memory); });
  }

  std::string large_ = directory_ / "large.nvdb";
};

TEST_F(MemoryCheck, NoStepFits_IsRefusedWithTheFirstOfThem) {
  EXPECT_EQ(refusal({large_, volume_}, {}, {100 * kKiB}),
            large_ +
                ": --memory 100.0 KiB is too small to render this grid, which takes 519.2 KiB at least; give --memory "
                "1MiB or more");
  EXPECT_EQ(refusal({volume_}, {}, {200 * kKiB, 2}),
            volume_ +
                ": --memory 200.0 KiB is too small to render this grid, which takes 288.1 KiB at least, 2 volumes of a "
                "series being held at a time; give --memory 1MiB or more");
}

TEST_F(MemoryCheck, OneStepFits_IsAccepted) {
  EXPECT_NO_THROW(check({large_, volume_}, {}, {400 * kKiB}));
  EXPECT_NO_THROW(check({large_}, {}, {600 * kKiB}));
}

TEST_F(MemoryCheck, FileToCompareWithThatDoesNotFit_IsRefused) {
  EXPECT_EQ(refusal({volume_}, {large_}, {400 * kKiB}).substr(0, large_.size() + 10), large_ + ": --memory");
  EXPECT_NO_THROW(check({volume_}, {volume_}, {400 * kKiB}));
}

TEST_F(MemoryCheck, StepThatCannotBeRead_IsLeftOut) {
  const std::string broken = directory_ / "broken.nvdb";
  write_file(broken, "no volume");
  EXPECT_NO_THROW(check({broken, volume_}, {}, {400 * kKiB}));
  EXPECT_EQ(refusal({broken, large_}, {}, {400 * kKiB}).substr(0, large_.size() + 10), large_ + ": --memory");
}

TEST_F(MemoryCheck, WithoutACeiling_NothingIsRefused) {
  EXPECT_NO_THROW(check({directory_ / "none.nvdb"}, {directory_ / "none.nvdb"}, {}));
}

TEST_F(MemoryCheck, Refusal_HasTheNameThatWasGiven) {
  ViewedFiles files;
  files.steps = {large_};
  const auto named = [](const std::string&) { return std::string("run.h5"); };
  const std::string said = message_of_error(ErrorKind::usage, [&] { require_memory(files, {100 * kKiB}, named); });
  EXPECT_EQ(said.substr(0, said.find(" is too small")), "run.h5: --memory 100.0 KiB");
}

}  // namespace
}  // namespace weir::memory_check_test
