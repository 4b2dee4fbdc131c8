// Tests the installed C interface: its symbols, its header in C and C++, its examples built by CMake and by pkg-config,
// and the document that shows the examples.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::c_api_test {
namespace {

const std::string kBindings = WEIR_SOURCE_DIR "/bindings/c";
const std::string kExamples = WEIR_SOURCE_DIR "/examples";

bool has_cuda() { return !std::string(WEIR_NVCC).empty(); }

/// Returns the lines of each block of `text` between "```language" and "```".
std::vector<std::string> blocks_of(const std::string& text, const std::string& language) {
  std::vector<std::string> blocks;
  const std::string begin = cat("\n```", language, "\n");
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    at += begin.size();
    blocks.push_back(text.substr(at, text.find("```\n", at) - at));
  }
  return blocks;
}

// A program that was linked with one version must find the same symbols in the next version. If a listed symbol
// changes, the library's soname must change.
TEST(CInterface, ExportsExactlyTheListedSymbols) {
  const CommandResult listed = run_command({"nm", "-D", "--defined-only", WEIR_C_LIBRARY});
  ASSERT_EQ(listed.exit_code, 0) << listed.err;
  std::istringstream lines(listed.out);
  std::set<std::string> symbols;
  for (std::string address, kind, symbol; lines >> address >> kind >> symbol;) {
    if (kind == "A") continue;  // the symbol of the version itself
    EXPECT_EQ(kind, "T") << symbol;
    symbols.insert(symbol);
  }
  std::string names = read_file(kBindings + "/weir.symbols");
  if (has_cuda()) names += read_file(kBindings + "/weir_cuda.symbols");
  std::set<std::string> expected;
  for (const std::string& name : split(names, '\n')) {
    if (!name.empty()) expected.insert(name + "@@WEIR_" WEIR_ABI);
  }
  EXPECT_EQ(symbols, expected);
}

TEST(CInterface, TheHeaderIsC99AndCPlusPlus) {
  const std::string header = kBindings + "/weir.h";
  const std::vector<std::string> strict{"-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"};
  for (const std::vector<std::string>& compiler :
       std::vector<std::vector<std::string>>{{WEIR_CC, "-x", "c", "-std=c99"}, {WEIR_CXX, "-x", "c++", "-std=c++11"}}) {
    std::vector<std::string> command = compiler;
    command.insert(command.end(), strict.begin(), strict.end());
    command.push_back(header);
    const CommandResult compiled = run_command(command);
    EXPECT_EQ(compiled.exit_code, 0) << compiled.err;
  }
}

// The document shows whole files and an excerpt.
TEST(CInterface, TheDocumentShowsTheCodeThatIsCompiled) {
  const std::string document = read_file(WEIR_SOURCE_DIR "/docs/embedding.md");
  std::string files;
  for (const char* name : {"convert_memory.c", "push/gray_scott.c", "push/gray_scott.f90", "push_cuda/gray_scott.cu"}) {
    files += read_file(cat(kExamples, "/", name));
  }
  std::size_t blocks = 0;
  for (const char* language : {"c", "fortran", "cuda"}) {
    for (const std::string& block : blocks_of(document, language)) {
      EXPECT_NE(files.find(block), std::string::npos) << "in no example:\n" << block;
      ++blocks;
    }
  }
  EXPECT_GE(blocks, 4U);
  const std::string build = read_file(kExamples + "/push/CMakeLists.txt");
  EXPECT_NE(document.find("```cmake\n" + build + "```\n"), std::string::npos);
}

#ifdef WEIR_INSTALLS  // not in builds with sanitizers

// A plugin host unloads its plugins. oneTBB's threads still run then, with code of a library that only weir needs.
TEST(CInterface, UnloadedAfterAConversion_TheProgramGoesOn) {
  const TemporaryDirectory directory;
  const std::string program = directory / "plugin_host";
  const CommandResult compiled =
      run_command({WEIR_CC, "-std=c99", "-D_DEFAULT_SOURCE", "-Wall", "-Werror", "-I", kBindings,
                   WEIR_SOURCE_DIR "/tests/tools/install/plugin_host.c", "-o", program, "-ldl"});
  ASSERT_EQ(compiled.exit_code, 0) << compiled.err;
  const CommandResult ran = run_command({program, WEIR_C_LIBRARY, directory / "a.nvdb"});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.out, "3 conversions\n");
}

bool has_program(const std::string& name) { return run_command({"sh", "-c", "command -v " + name}).exit_code == 0; }

/// Returns options with a timeout that is long enough for a build on a busy machine.
CommandOptions patient() {
  CommandOptions options;
  options.timeout = std::chrono::seconds(600);
  return options;
}
CommandOptions with_environment(const std::string& variable) {
  CommandOptions options;
  options.environment = {variable};
  return options;
}

class CExamples : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = std::make_unique<TemporaryDirectory>();
    const CommandResult installed =
        run_command({WEIR_CMAKE, "--install", WEIR_INSTALLS, "--strip", "--prefix", prefix()});
    ASSERT_EQ(installed.exit_code, 0) << installed.out << installed.err;
    const std::string build = *directory_ / "build";
    const CommandResult configured = run_command(
        {WEIR_CMAKE, "-S", kExamples + "/push", "-B", build, "-G", WEIR_GENERATOR, "-DCMAKE_BUILD_TYPE=Release",
         "-DCMAKE_C_COMPILER=" WEIR_CC, "-DCMAKE_C_FLAGS=-std=c99 -pedantic -Wall -Wextra -Wconversion -Werror",
         "-DCMAKE_Fortran_FLAGS=-std=f2008 -Wall -Wextra -Werror", "-DCMAKE_PREFIX_PATH=" + prefix()},
        patient());
    ASSERT_EQ(configured.exit_code, 0) << configured.out << configured.err;
    const CommandResult built = run_command({WEIR_CMAKE, "--build", build}, patient());
    ASSERT_EQ(built.exit_code, 0) << built.out << built.err;
  }
  static void TearDownTestSuite() { directory_.reset(); }

  static std::string prefix() { return *directory_ / "weir"; }
  static std::string program(const std::string& name) { return *directory_ / ("build/" + name); }

  /// Runs `program`, a simulation, and expects the files of two steps with the budget that it requested. Plays the
  /// files.
  static void expect_steps(const std::string& program) {
    const TemporaryDirectory steps;
    const CommandResult simulated = run_command({program, "44", "40", "20", steps.path()});
    ASSERT_EQ(simulated.exit_code, 0) << simulated.out << simulated.err;
    const std::vector<std::string> files{"v_0020.nvdb", "v_0020.nvdb.json", "v_0040.nvdb", "v_0040.nvdb.json"};
    EXPECT_EQ(list_directory(steps.path()), files);
    for (const char* name : {"v_0020.nvdb", "v_0040.nvdb"}) {
      const CommandResult verified = run_weir({"verify", steps / name});
      EXPECT_EQ(verified.exit_code, 0) << verified.err;
      const auto sidecar = nlohmann::json::parse(read_file(steps / cat(name, ".json")));
      EXPECT_EQ(sidecar["source"]["extent"], (std::vector<int>{44, 44, 44}));
      EXPECT_EQ(sidecar["grid"]["name"], "v");
      EXPECT_GT(sidecar["value_range"][1], 0.1);
      EXPECT_LT(sidecar["value_range"][1], 1.0);
      EXPECT_GE(sidecar["error"]["psnr_db"], 50.0);
    }
    const CommandResult played =
        run_weir({"play", steps / "v_*.nvdb", "-o", steps / "frames", "--size", "40x30", "--spp", "1"});
    EXPECT_EQ(played.exit_code, 0) << played.err;
    EXPECT_EQ(list_directory(steps / "frames"), (std::vector<std::string>{"frame_00000.png", "frame_00001.png"}));

    const CommandResult refused = run_command({program, "20", "1", "1", steps / "none"});
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_NE((refused.out + refused.err).find("none does not exist; make it or choose another output"),
              std::string::npos)
        << refused.out << refused.err;
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> directory_;
};

TEST_F(CExamples, ASimulationInCPushesItsSteps) { expect_steps(program("gray_scott")); }

TEST_F(CExamples, ASimulationInFortranPushesItsSteps) {
  if (!has_program("gfortran")) GTEST_SKIP() << "no gfortran";
  expect_steps(program("gray_scott_fortran"));
}

TEST_F(CExamples, PkgConfigFindsTheLibrary) {
  if (!has_program("pkg-config")) GTEST_SKIP() << "no pkg-config";
  const TemporaryDirectory work;
  const std::string compile =
      cat(WEIR_CC, " -std=c99 -pedantic -Wall -Wextra -Wconversion -Werror -o ", work / "convert_memory", ' ',
          kExamples, "/convert_memory.c $(pkg-config --cflags --libs weir)");
  const CommandResult compiled =
      run_command({"sh", "-c", compile}, with_environment("PKG_CONFIG_PATH=" + prefix() + "/lib/pkgconfig"));
  ASSERT_EQ(compiled.exit_code, 0) << compiled.out << compiled.err;
  const CommandResult ran =
      run_command({work / "convert_memory"}, with_environment("LD_LIBRARY_PATH=" + prefix() + "/lib"));
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.out, "4194304 bytes of values became 2255232, each within 1.97656\n5020 5045\n");
  const std::string document = read_file(WEIR_SOURCE_DIR "/docs/embedding.md");
  EXPECT_NE(document.find(ran.out), std::string::npos) << ran.out;
}

#endif

}  // namespace
}  // namespace weir::c_api_test
