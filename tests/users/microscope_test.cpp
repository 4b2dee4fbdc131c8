// Tests a stack of two channels from a microscope, as ilastik and Fiji write it into HDF5. The voxel size is in
// micrometres, in the order of the file's axes. The planes are thicker than the pixels are wide.
#include "tests/users/user_script.h"

namespace weir::microscope_test {
namespace {

class Microscope : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
    write_inputs(R"(
z, y, x = np.mgrid[0:20, 0:48, 0:64]
nuclei = (900 * np.exp(-((x - 30)**2 + (y - 20)**2 + (4 * (z - 10))**2) / 90.0) + 100).astype("u2")
membranes = (200 + 100 * ((x + y) % 9 == 0)).astype("u2")
with h5py.File("cells.h5", "w") as f:
    d = f.create_dataset("volume", data=np.stack([nuclei, membranes]), chunks=(1, 8, 16, 16), compression="gzip")
    d.attrs["element_size_um"] = [1.5, 0.2, 0.2]
nuclei.tofile("nuclei_64x48x20_uint16.raw")
)");
  }
};

TEST_F(Microscope, AChannelIsAPositionOnTheFirstAxis) {
  const CommandResult refused = weir({"convert", "cells.h5", "--lossless"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--index"), std::string::npos) << refused.err;
  ASSERT_EQ(weir({"convert", "cells.h5", "--index", "0", "--lossless", "-o", "nuclei.nvdb"}).exit_code, 0);
  EXPECT_EQ(weir({"compare", "nuclei_64x48x20_uint16.raw", "nuclei.nvdb"}).out,
            "lossless: all 61440 finite voxels read bit for bit\n");
}

TEST_F(Microscope, VoxelsAreAsThickAsThePlanes) {
  ASSERT_EQ(weir({"convert", "cells.h5", "--index", "0", "--lossless", "-o", "nuclei.nvdb"}).exit_code, 0);
  EXPECT_EQ(sidecar("nuclei.nvdb")["grid"]["voxel_size"], (nlohmann::json{0.2, 0.2, 1.5}));
  const CommandResult inspected = weir({"inspect", "nuclei.nvdb"});
  EXPECT_NE(inspected.out.find("transform   voxel size 0.2, 0.2, 1.5, origin 0, 0, 0\n"), std::string::npos)
      << inspected.out;
}

TEST_F(Microscope, AllChannels_HaveFilesOfTheirOwn) {
  ASSERT_EQ(weir({"convert", "cells.h5", "--index", "*", "--lossless", "-o", "channels/"}).exit_code, 0);
  EXPECT_EQ(list_directory(directory_ / "channels"),
            (std::vector<std::string>{"cells_0.nvdb", "cells_0.nvdb.json", "cells_1.nvdb", "cells_1.nvdb.json"}));
}

}  // namespace
}  // namespace weir::microscope_test
