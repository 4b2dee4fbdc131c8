// Tests that tools/structure.py finds every kind of fault that it looks for, and names its place.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "format/base/text.h"
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
  add("gpu/long.cpp", std::string(401, '\n'));
  add("ingest/one.h", "// Uses the other.\n#pragma once\n#include \"ingest/other.h\"\n");
  add("ingest/other.h", "// Is used.\n#pragma once\nnamespace weir {\nstruct Extent {};\n}\n");
  add("ingest/other.cpp", "#include \"ingest/other.h\"\n#include \"ingest/one.h\"\n");
  add("tools/plot/axis.h", "// Uses a room that uses this one.\n#pragma once\n#include \"tools/report/text.h\"\n");
  add("tools/plot/line.h", "// Is used by it.\n#pragma once\n");
  add("tools/report/text.h", "// Uses it.\n#pragma once\n#include \"tools/plot/line.h\"\n");
  add("gpu/extent.cpp",
      "namespace weir {\nnamespace {\nstruct Own {};\n}\nclass Extent final {\n  struct Part {};\n};\n}\n");
  add("gpu/mask.h",
      "// 1.\n#pragma once\nnamespace weir {\nconstexpr int kMany = f(16'384, '{');\ntemplate <int N>\nstruct Mask "
      "{};\n}\n");
  add("format/mask.h",
      "// 2.\n#pragma once\nnamespace weir {\ntemplate <int N>\nstruct Mask {};\ntemplate <>\nstruct Mask<1> {};\n}\n");
  add("gpu/own.cpp", "namespace weir {\nnamespace {\nstruct Own {};\n}\n}\n");
  for (int i = 0; i <= 40; ++i) add(cat("tests/many/", i, ".cpp"), "\n");
  add("attic/a.cpp", "\n");
  add("alone.h", "// In no folder.\n#pragma once\n");
  add("CONTRIBUTING.md", "## Where things are\n\n```\nformat/  files\ntools/   the command\n  plot/    charts\n```\n");
  CommandOptions there;
  there.directory = directory.path();
  ASSERT_EQ(run_command({"git", "init", "--quiet"}, there).exit_code, 0);
  ASSERT_EQ(run_command({"git", "add", "."}, there).exit_code, 0);
  const CommandResult result = run_command({kPython, WEIR_SOURCE_DIR "/tools/structure.py", directory.path().string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out,
            "alone.h:1: alone.h/ is no folder of C++ files; name it in tools/structure.py with what it may include\n"
            "attic/a.cpp:1: attic/ is no folder of C++ files; name it in tools/structure.py with what it may include\n"
            "daemon/service.h:4: there is no \"format/gone.h\"\n"
            "format/bare.h:1: begins without a comment that says what it is for\n"
            "format/bare.h:1: has no #pragma once\n"
            "format/up.h:3: format/ is below daemon/ and may not include \"daemon/service.h\"\n"
            "gpu/long.cpp:401: has 401 lines, more than 400; split it\n"
            "CONTRIBUTING.md:5: the map does not name tools/report/; add what it holds\n"
            "ingest/one: includes run in a circle: ingest/one, ingest/other\n"
            "daemon: includes run in a circle: daemon, format\n"
            "tools/plot: includes run in a circle: tools/plot, tools/report\n"
            "ingest/other.h:4: weir::Extent is defined in gpu/extent.cpp:5, too; rename one\n"
            "gpu/mask.h:6: weir::Mask is defined in format/mask.h:5, too; rename one\n"
            "tests/many/: has 41 files, more than 40; part it\n");
}

}  // namespace
}  // namespace weir::structure_test
