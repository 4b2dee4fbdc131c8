// Tests docs/mpi.md: its commands install weir-mpi and build the example, and both programs find their libraries.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

#ifdef WEIR_MPI_INSTALLS  // not without MPI, nor in builds with sanitizers

namespace weir::mpi_install_test {
namespace {

TEST(MpiInstallation, CommandsOfTheDocumentBuildTheExample) {
  const TemporaryDirectory home;
  std::filesystem::create_directory(home / "build");
  std::filesystem::create_symlink(WEIR_MPI_INSTALLS, home / "build/release");
  write_file(home / "heat.c", read_file(WEIR_SOURCE_DIR "/examples/mpi/heat.c"));
  std::string script = "set -e\ncmake() { '" WEIR_CMAKE "' \"$@\"; }\nmpicc() { '" WEIR_MPICC "' \"$@\"; }\n";
  int shown = 0;
  for (const std::string& line : split(read_file(WEIR_SOURCE_DIR "/docs/mpi.md"), '\n')) {
    if (!line.starts_with("cmake ") && !line.starts_with("mpicc ")) continue;
    script += line + '\n';
    ++shown;
  }
  ASSERT_EQ(shown, 3);
  CommandOptions options;
  options.timeout = std::chrono::minutes(5);
  options.directory = home.path();
  options.environment = {cat("HOME=", home.path().string())};
  const CommandResult made = run_command({"sh", "-c", script}, options);
  ASSERT_EQ(made.exit_code, 0) << made.out << made.err;

  for (const char* program : {"heat", "weir/bin/weir-mpi"}) {
    const std::string libraries = run_command({"ldd", home / program}).out;
    EXPECT_NE(libraries.find("libmpi"), std::string::npos) << program << '\n' << libraries;
    EXPECT_EQ(libraries.find("not found"), std::string::npos) << program << '\n' << libraries;
  }
  const std::string libraries = run_command({"ldd", home / "heat"}).out;
  for (const char* library : {"libweir.so", "libweir_mpi.so"}) {
    EXPECT_NE(libraries.find(cat(" => ", home / "weir/lib/", library)), std::string::npos) << libraries;
  }
  EXPECT_TRUE(std::filesystem::exists(home / "weir/bin/weir"));
}

}  // namespace
}  // namespace weir::mpi_install_test

#endif
