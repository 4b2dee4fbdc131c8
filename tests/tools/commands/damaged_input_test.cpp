// Tests commands that make a new file of a volume whose bytes differ from the certified bytes.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/tools/support/converted_volume.h"

namespace weir::damaged_input_test {
namespace {

namespace fs = std::filesystem;

class DamagedInput : public ConvertedVolume {
 protected:
  // Flips one bit in the middle of the leaves.
  void damage() const {
    std::string file = read_file(volume_);
    char& byte = file[file.size() / 2];
    byte = static_cast<char>(byte ^ 1);
    write_file(volume_, file);
  }
  std::string refusal() const {
    return "weir: " + volume_ + ": has other bytes than " + sidecar_path(volume_) +
           " certifies: a copy broke off, or a disk or memory is faulty; copy it or convert it again, or move the "
           "sidecar away to take the values as they are\n";
  }
  CommandResult convert() const {
    return run_weir({"convert", volume_, "-o", again_, "--lossless", "--progress", "never"});
  }

  static bool lacks_openvdb(const CommandResult& result) {
    return result.err.find("weir_openvdb.so") != std::string::npos;
  }

  std::string again_ = directory_ / "again.nvdb";
  std::string exported_ = directory_ / "v.vdb";
};

TEST_F(DamagedInput, ConvertAndExportRefuseIt) {
  damage();
  const CommandResult converted = convert();
  EXPECT_EQ(converted.err, refusal());
  EXPECT_EQ(converted.exit_code, 3);
  EXPECT_FALSE(fs::exists(again_));
  const CommandResult exported = run_weir({"export", volume_, "-o", exported_, "--progress", "never"});
  if (!lacks_openvdb(exported)) {
    EXPECT_EQ(exported.err, refusal());
    EXPECT_EQ(exported.exit_code, 3);
  }
  EXPECT_FALSE(fs::exists(exported_));
}

TEST_F(DamagedInput, ExportToANameThatIsTaken_IsRefusedBeforeAllIsRead) {
  damage();
  write_file(exported_, "theirs");
  const CommandResult exported = run_weir({"export", volume_, "-o", exported_, "--progress", "never"});
  if (lacks_openvdb(exported)) GTEST_SKIP() << "without OpenVDB's library";
  EXPECT_EQ(exported.exit_code, 2);
  EXPECT_EQ(exported.err, "weir: " + exported_ + ": exists; choose another output or pass --overwrite\n");
  EXPECT_EQ(read_file(exported_), "theirs");
}

TEST_F(DamagedInput, WithoutASidecarItsValuesAreTaken) {
  damage();
  fs::remove(sidecar_path(volume_));
  const CommandResult converted = convert();
  EXPECT_EQ(converted.exit_code, 0) << converted.err;
  EXPECT_TRUE(fs::exists(again_));
}

TEST_F(DamagedInput, SidecarOfAnotherVolumeIsSaid) {
  const std::string other = directory_ / "other.nvdb";
  ASSERT_EQ(run_weir({"convert", volume_, "-o", other, "--lossless", "-q"}).exit_code, 0);
  fs::copy_file(sidecar_path(other), sidecar_path(volume_), fs::copy_options::overwrite_existing);
  const CommandResult converted = convert();
  EXPECT_EQ(converted.exit_code, 0);
  EXPECT_NE(converted.err.find(sidecar_path(volume_) + ": is of another volume than " + volume_ + "; whether " +
                               volume_ + " is damaged is not known"),
            std::string::npos)
      << converted.err;
}

TEST_F(DamagedInput, IntactOneIsConvertedWithoutAWord) {
  const CommandResult converted = run_weir({"convert", volume_, "-o", again_, "--lossless", "-q"});
  EXPECT_EQ(converted.exit_code, 0);
  EXPECT_EQ(converted.err, "");
}

}  // namespace
}  // namespace weir::damaged_input_test
