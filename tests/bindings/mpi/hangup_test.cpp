// What weir-mpi ends with where its terminal is closed.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/bindings/mpi/run_mpi.h"
#include "tests/support/temporary_directory.h"

namespace weir::mpi_hangup_test {
namespace {

namespace fs = std::filesystem;

TEST(MpiHangup, EndsWith129AndNothingIsLeft) {
  const TemporaryDirectory directory;
  const std::string zeros = directory / "zeros_1024x1024x1024_uint8.raw";
  write_file(zeros, "");
  fs::resize_file(zeros, std::uintmax_t{1} << 30U);
  const std::string hang_up =
      "\"$@\" & while kill -0 $! && ! [ -e mpi.nvdb.partial ]; do sleep 0.01; done; kill -HUP $!; wait $!; echo $?";
  const CommandResult run =
      run_mpi(1, {"sh", "-c", hang_up, "sh", WEIR_MPI_COMMAND, "convert", zeros, "-o", "mpi.nvdb", "--lossless"},
              directory.path());
  EXPECT_EQ(run.out, "129\n");
  EXPECT_EQ(line_of(run.err, "weir-mpi"), "weir-mpi: interrupted; nothing was written");
  EXPECT_EQ(list_directory(directory.path()), std::vector<std::string>{"zeros_1024x1024x1024_uint8.raw"});
}

}  // namespace
}  // namespace weir::mpi_hangup_test
