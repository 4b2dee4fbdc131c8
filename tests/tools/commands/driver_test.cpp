// Formats that need a library of others, where weir's part for it (ingest/drivers) is missing, broken or of another
// version.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/run_command.h"

namespace weir::driver_test {
namespace {

class Driver : public testing::Test {
 protected:
  Driver() {
    write_file(hdf5_, std::string("\x89HDF\r\n\x1a\n", 8) + std::string(2040, '\0'));
    std::filesystem::create_directory(drivers_);
  }

  std::string refusal(const std::vector<std::string>& arguments) const {
    CommandOptions options;
    options.environment = {"WEIR_DRIVERS=" + drivers_};
    std::vector<std::string> all{WEIR_COMMAND};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = run_command(all, options);
    EXPECT_EQ(result.exit_code, 3);
    return result.err;
  }

  TemporaryDirectory directory_;
  std::string hdf5_ = directory_ / "a.h5";
  std::string drivers_ = directory_ / "drivers";
};

TEST_F(Driver, Missing_IsSaidWithTheRemedy) {
  EXPECT_EQ(refusal({"convert", hdf5_}),
            "weir: " + hdf5_ +
                ": is an HDF5 file, and this weir has no weir_hdf5.so, which it takes; build it with "
                "-DWEIR_HDF5=ON, or name the folder it lies in by the environment's WEIR_DRIVERS\n");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "a.nvdb"));
}

TEST_F(Driver, MissingForAnExport_IsSaidBeforeAnythingIsWritten) {
  const std::string volume = directory_ / "v_16x16x16_float32.raw";
  const std::string grid = directory_ / "v.nvdb";
  ASSERT_EQ(run_weir({"sample", "sphere", "--dims", "16,16,16", "-o", volume}).exit_code, 0);
  ASSERT_EQ(run_weir({"convert", volume, "-o", grid, "--lossless"}).exit_code, 0);
  const std::string output = directory_ / "v.vdb";
  EXPECT_EQ(refusal({"export", grid, "-o", output}),
            "weir: " + output +
                ": is to be an OpenVDB file, and this weir has no weir_openvdb.so, which it takes; "
                "build it with -DWEIR_OPENVDB=ON, or name the folder it lies in by the environment's WEIR_DRIVERS\n");
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Driver, NoSharedObject_IsSaid) {
  write_file(drivers_ + "/weir_hdf5.so", "text");
  const std::string message = refusal({"convert", hdf5_});
  EXPECT_EQ(message.find("weir: " + hdf5_ + ": is an HDF5 file, and " + drivers_ + "/weir_hdf5.so cannot be loaded: "),
            0U)
      << message;
  EXPECT_NE(message.find("; install what it needs\n"), std::string::npos) << message;
}

TEST_F(Driver, OfAnotherVersion_IsSaid) {
  // A shared object without the entry: any library of the system.
  const CommandResult found = run_command({"sh", "-c", "ls /lib/*/libm.so.6 /lib64/libm.so.6 2>/dev/null | head -1"});
  std::filesystem::copy_file(found.out.substr(0, found.out.find('\n')), drivers_ + "/weir_hdf5.so");
  EXPECT_EQ(refusal({"convert", hdf5_}),
            "weir: " + hdf5_ + ": is an HDF5 file, and " + drivers_ +
                "/weir_hdf5.so is of another version of weir; install weir_hdf5.so of this "
                "one\n");
}

}  // namespace
}  // namespace weir::driver_test
