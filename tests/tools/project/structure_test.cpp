// tools/structure.py: every fault that it looks for is found, and where.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/python.h"
#include "tests/support/run_command.h"

namespace weir::structure_test {
namespace {

TEST(Structure, EveryFaultIsNamedWithItsPlace) {
  const TemporaryDirectory directory;
  const auto add = [&](const std::string& name, const std::string& text) {
    const std::string path = directory / name;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    write_file(path, text);
  };
  add("format/fine.h", "// What it is for.\n#pragma once\n");
  add("format/up.h", "// Includes what stands above it.\n#pragma once\n#include \"daemon/service.h\"\n");
  add("format/bare.h", "\n");
  add("daemon/service.h", "// A service.\n#pragma once\n#include \"format/fine.h\"\n#include \"format/gone.h\"\n");
  add("gpu/long.cpp", std::string(601, '\n'));
  add("attic/a.cpp", "\n");
  CommandOptions there;
  there.directory = directory.path();
  ASSERT_EQ(run_command({"git", "init", "--quiet"}, there).exit_code, 0);
  ASSERT_EQ(run_command({"git", "add", "."}, there).exit_code, 0);
  const CommandResult result = run_command({kPython, WEIR_SOURCE_DIR "/tools/structure.py", directory.path().string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out,
            "attic/a.cpp:1: attic/ is no folder of C++ files; name it in tools/structure.py with what it may include\n"
            "daemon/service.h:4: there is no \"format/gone.h\"\n"
            "format/bare.h:1: begins without a comment that says what it is for\n"
            "format/bare.h:1: has no #pragma once\n"
            "format/up.h:3: format/ is below daemon/ and may not include \"daemon/service.h\"\n"
            "gpu/long.cpp:601: has 601 lines, more than 600; split it\n");
}

}  // namespace
}  // namespace weir::structure_test
