// Tests commands that need a library of others when weir's driver for it (ingest/drivers) is missing, broken or of
// another build.
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
    EXPECT_EQ(result.exit_code, 5);
    return result.err;
  }

  TemporaryDirectory directory_;
  std::string hdf5_ = directory_ / "a.h5";
  std::string drivers_ = directory_ / "drivers";
};

TEST_F(Driver, Missing_IsSaidWithTheRemedy) {
  EXPECT_EQ(refusal({"convert", hdf5_}),
            "weir: " + hdf5_ + ": is an HDF5 file, for which weir loads weir_hdf5.so, and that failed: " + drivers_ +
                "/weir_hdf5.so: cannot open shared object file: No such file or directory; install it with weir, or "
                "build weir with -DWEIR_HDF5=ON\n");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "a.nvdb"));
}

TEST_F(Driver, MissingForAnExport_IsSaidBeforeAnythingIsWritten) {
  const std::string volume = directory_ / "v_16x16x16_float32.raw";
  const std::string grid = directory_ / "v.nvdb";
  ASSERT_EQ(run_weir({"sample", "sphere", "--dims", "16,16,16", "-o", volume}).exit_code, 0);
  ASSERT_EQ(run_weir({"convert", volume, "-o", grid, "--lossless"}).exit_code, 0);
  for (const std::string& output : {directory_ / "v.vdb", directory_ / "v.png"}) {
    const bool chart = output.ends_with(".png");
    const std::string message =
        chart ? refusal({"inspect", grid, "--plot", output}) : refusal({"export", grid, "-o", output});
    const std::string begin =
        "weir: " + output +
        (chart ? ": is to be a chart, for which weir loads weir_plot.so, and that failed: "
               : ": is to be an OpenVDB file, for which weir loads weir_openvdb.so, and that failed: ");
    EXPECT_EQ(message.substr(0, begin.size()), begin);
    EXPECT_FALSE(std::filesystem::exists(output));
  }
}

TEST_F(Driver, NoSharedObject_IsSaid) {
  write_file(drivers_ + "/weir_hdf5.so", "text");
  const std::string begin =
      "weir: " + hdf5_ + ": is an HDF5 file, for which weir loads weir_hdf5.so, and that failed: ";
  EXPECT_EQ(refusal({"convert", hdf5_}).substr(0, begin.size()), begin);
}

TEST_F(Driver, OfAnotherBuild_IsSaid) {
  // A shared object without the entry point: any library of the system.
  const CommandResult found = run_command({"sh", "-c", "ls /lib/*/libm.so.6 /lib64/libm.so.6 2>/dev/null | head -1"});
  std::filesystem::copy_file(found.out.substr(0, found.out.find('\n')), drivers_ + "/weir_hdf5.so");
  EXPECT_EQ(refusal({"convert", hdf5_}),
            "weir: " + hdf5_ +
                ": is an HDF5 file, for which weir loads weir_hdf5.so, and that is of another build of "
                "weir; start weir again after an update, or install both of one build\n");
}

TEST_F(Driver, FolderThatIsNotAbsolute_IsRefused) {
  CommandOptions options;
  options.environment = {"WEIR_DRIVERS=drivers"};
  options.directory = directory_.path();
  const CommandResult result = run_command({WEIR_COMMAND, "convert", hdf5_}, options);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "weir: " + hdf5_ +
                            ": is an HDF5 file, and WEIR_DRIVERS is \"drivers\", it must be an absolute "
                            "path; unset it or mend it\n");
}

TEST_F(Driver, SweepWithoutOne_DrawsNoChartsAndLeavesNoOldOnes) {
  const std::string volume = directory_ / "v_16x16x16_float32.raw";
  ASSERT_EQ(run_weir({"sample", "sphere", "--dims", "16,16,16", "-o", volume}).exit_code, 0);
  const std::string output = directory_ / "sweep";
  std::filesystem::create_directory(output);
  write_file(output + "/psnr_bits.png", "of an earlier sweep");
  CommandOptions options;
  options.environment = {"WEIR_DRIVERS=" + drivers_};
  const CommandResult result = run_command(
      {WEIR_COMMAND, "sweep", volume, "-o", output, "--rates", "1", "--methods", "float", "--overwrite"}, options);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(output +
                            ": no charts are drawn, for which weir loads weir_plot.so, and that failed: " + drivers_ +
                            "/weir_plot.so: cannot open shared object file: No such file or directory; "
                            "install it with weir, or build weir with -DWEIR_PLOT=ON"),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.out.find("float"), std::string::npos);
  EXPECT_EQ(list_directory(output), (std::vector<std::string>{"sweep.csv", "sweep.json"}));
}

}  // namespace
}  // namespace weir::driver_test
