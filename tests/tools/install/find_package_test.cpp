// Tests find_package(weir) if something is missing. The test puts cmake/weirConfig.cmake beside targets that are only
// names.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::find_package_test {
namespace {

constexpr const char* kTargets = R"(
foreach(name IN ITEMS NAMES)
  if(NOT TARGET weir::${name})
    add_library(weir::${name} INTERFACE IMPORTED)
  endif()
endforeach()
)";

constexpr const char* kFindMpi = R"(
if(NOT CMAKE_C_COMPILER)
  message(FATAL_ERROR "FindMPI is asked, by a project that does not compile C")
endif()
set(MPI_FOUND ${MPI_IS_THERE})
set(MPI_C_FOUND ${MPI_IS_THERE})
)";

constexpr const char* kProject = R"(
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES NONE)
set(CMAKE_MODULE_PATH ${PROJECT_SOURCE_DIR})
set(weir_DIR ${PROJECT_SOURCE_DIR}/weir)
find_package(weir QUIET ${ARGUMENTS})
set(targets)
foreach(name IN ITEMS format_core gpu_core c mpi cuda)
  if(TARGET weir::${name})
    list(APPEND targets ${name})
  endif()
endforeach()
if(weir_FOUND)
  file(WRITE ${PROJECT_SOURCE_DIR}/found "${targets}, mpi: ${weir_mpi_FOUND}")
else()
  file(WRITE ${PROJECT_SOURCE_DIR}/found "${weir_NOT_FOUND_MESSAGE}")
endif()
)";

constexpr const char* kWithMpi = "format_core;gpu_core;c;mpi, mpi: TRUE";
constexpr const char* kWithoutMpi = "format_core;gpu_core;c, mpi: FALSE";

/// An installation with the component mpi and without CUDA, and a project that looks for the installation.
class FindPackage : public ::testing::Test {
 protected:
  FindPackage() {
    std::filesystem::create_directory(files_ / "weir");
    std::filesystem::copy_file(WEIR_SOURCE_DIR "/cmake/weirConfig.cmake", files_ / "weir/weirConfig.cmake");
    write_targets("weirTargets", "format_core gpu_core");
    write_targets("weirCTargets", "c");
    write_targets("weirMpiTargets", "mpi");
    write_file(files_ / "FindMPI.cmake", kFindMpi);
    write_file(files_ / "CMakeLists.txt", kProject);
  }

  /// Returns what find_package(weir QUIET `arguments`) finds, or why it finds nothing.
  std::string find(const std::string& arguments, bool compiles_c, bool has_mpi) const {
    const CommandResult configured =
        run_command({WEIR_CMAKE, "-S", files_.path(), "-B", files_ / "build", "-G", WEIR_GENERATOR,
                     cat("-DARGUMENTS=", arguments), compiles_c ? "-DCMAKE_C_COMPILER=cc" : "-UCMAKE_C_COMPILER",
                     cat("-DMPI_IS_THERE=", has_mpi ? "TRUE" : "FALSE")});
    EXPECT_EQ(configured.exit_code, 0) << configured.err;
    return read_file(files_ / "found");
  }
  static std::string missing(const std::string& component, const std::string& there) {
    return cat(
        "it has no component ", component, " here, but: ", there,
        ". mpi has to be installed besides, and needs a project of the language C and an MPI; cuda needs one of the "
        "language CUDA");
  }

 private:
  void write_targets(const std::string& file, const std::string& names) const {
    std::string text = kTargets;
    write_file(files_ / cat("weir/", file, ".cmake"), text.replace(text.find("NAMES"), 5, names));
  }

  const TemporaryDirectory files_;
};

TEST_F(FindPackage, TakesMpiWhereItCanBeUsed) {
  EXPECT_EQ(find("", true, true), kWithMpi);
  EXPECT_EQ(find("COMPONENTS;mpi;c", true, true), kWithMpi);
}

TEST_F(FindPackage, BringsTheRestWithoutMpi) {
  EXPECT_EQ(find("", true, false), kWithoutMpi);
  EXPECT_EQ(find("OPTIONAL_COMPONENTS;mpi", true, false), kWithoutMpi);
  EXPECT_EQ(find("REQUIRED;COMPONENTS;c;format_core", true, false), kWithoutMpi);
}

TEST_F(FindPackage, BringsTheRestToAProjectWithoutC) {
  EXPECT_EQ(find("", false, true), kWithoutMpi);
  EXPECT_EQ(find("OPTIONAL_COMPONENTS;mpi", false, true), kWithoutMpi);
}

TEST_F(FindPackage, RefusesAComponentThatIsMissing) {
  EXPECT_EQ(find("COMPONENTS;mpi", true, false), missing("mpi", "format_core gpu_core c"));
  EXPECT_EQ(find("COMPONENTS;mpi", false, true), missing("mpi", "format_core gpu_core c"));
  EXPECT_EQ(find("COMPONENTS;cuda", true, true), missing("cuda", "format_core gpu_core c mpi"));
  EXPECT_EQ(find("COMPONENTS;c;none", true, true), missing("none", "format_core gpu_core c mpi"));
}

}  // namespace
}  // namespace weir::find_package_test
