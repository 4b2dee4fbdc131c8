// Tests the result of cmake --install: exactly the listed files, a command that runs, and libraries that another build
// can use.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/python.h"
#include "tests/support/run_command.h"
#include "tests/tools/support/embedded_example.h"

#ifdef WEIR_INSTALLS  // not in builds with sanitizers

namespace weir::install_test {
namespace {

namespace fs = std::filesystem;

#ifdef WEIR_PYTHON_CORE
const std::string kPythonFolder = "lib/python" WEIR_PYTHON_VERSION "/dist-packages";  // the folder below /usr/local
#else
const std::string kPythonFolder;
#endif

class Installation : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = std::make_unique<TemporaryDirectory>();
    const CommandResult installed =
        run_command({WEIR_CMAKE, "--install", WEIR_INSTALLS, "--strip", "--prefix", prefix()});
    ASSERT_EQ(installed.exit_code, 0) << installed.out << installed.err;
  }
  static void TearDownTestSuite() { directory_.reset(); }

  static std::string prefix() { return *directory_ / "weir"; }
  static bool has_cuda() { return !std::string(WEIR_NVCC).empty(); }

 private:
  static inline std::unique_ptr<TemporaryDirectory> directory_;
};

/// Adds the files (no directories) below `root` to `files`, as paths below `as`.
void add_files(const fs::path& root, const std::string& as, std::set<std::string>& files) {
  for (const std::string& path : list_directory(root)) {
    if (!path.ends_with('/')) files.insert(cat(as, "/", path));
  }
}

std::set<std::string> headers() {
  std::set<std::string> files;
  for (const char* name : {"io/descriptor",
                           "base/error",
                           "base/message",
                           "io/file_mapping",
                           "io/refused_open",
                           "base/host_device",
                           "base/index",
                           "base/mix_bits",
                           "leaf/bounds",
                           "leaf/leaf_decode",
                           "nanovdb/macrocells",
                           "layout/nanovdb_layout",
                           "nanovdb/nvdb_blind",
                           "nanovdb/nvdb_bytes",
                           "nanovdb/nvdb_file",
                           "nanovdb/nvdb_grid",
                           "nanovdb/nvdb_header",
                           "nanovdb/nvdb_tree",
                           "layout/nvdb_type",
                           "nanovdb/range_max",
                           "base/text",
                           "process/group_memory",
                           "base/kernel_table",
                           "process/process_memory",
                           "base/simd",
                           "base/transpose_lanes",
                           "nanovdb/grid_block",
                           "nanovdb/packed_blocks",
                           "packed/block_constants",
                           "packed/block_context",
                           "packed/block_decode",
                           "packed/block_scan",
                           "packed/block_steps",
                           "packed/coefficient_decoder",
                           "packed/coefficient_values",
                           "packed/inverse_transform",
                           "packed/lattice_codes",
                           "nanovdb/packed_chunk",
                           "nanovdb/packed_data",
                           "nanovdb/packed_header",
                           "packed/packed_layout",
                           "packed/stream_length"}) {
    files.insert(cat("include/weir/format/", name, ".h"));
  }
  for (const char* name : {"image/colormap",
                           "math/dda",
                           "scene/environment_view",
                           "trace/iso_surface",
                           "volume/leaf_table",
                           "scene/lighting",
                           "volume/macrocell_grid",
                           "trace/max_projection",
                           "trace/medium",
                           "trace/path_tracer",
                           "trace/phase",
                           "math/portable",
                           "math/random",
                           "math/ray",
                           "trace/ray_march",
                           "trace/tracking",
                           "scene/transfer_function",
                           "math/vector3",
                           "volume/level_choice",
                           "volume/volume_sampler",
                           "volume/decoded_leaves",
                           "volume/block_cache",
                           "volume/cached_blocks"}) {
    files.insert(cat("include/weir/gpu/", name, ".h"));
  }
  return files;
}

std::set<std::string> cuda_files() {
  std::set<std::string> files{"include/weir_cuda.h", "lib/libweir_cuda.a", "lib/cmake/weir/weirCudaTargets.cmake",
                              "lib/cmake/weir/weirCudaTargets-release.cmake"};
  for (const char* name : {"runtime/check", "runtime/device_array", "device_buffer", "grid_loader", "load/copy_task",
                           "load/direct_storage", "load/load_report", "load/pinned_memory", "load/pinned_ring",
                           "load/registered_range", "load/zero_copy"}) {
    files.insert(cat("include/weir/gpu/cuda/", name, ".h"));
  }
  return files;
}

// Returns the files of the Python module, which lies in `folder`.
std::set<std::string> python_files([[maybe_unused]] const std::string& folder) {
  std::set<std::string> files;
#ifdef WEIR_PYTHON_CORE
  files.insert({"share/weir/paraview/weir_reader.py", cat(folder, "/weir/" WEIR_PYTHON_CORE)});
  for (const char* name : {"METADATA", "entry_points.txt"}) {
    files.insert(cat(folder, "/weir-" WEIR_VERSION ".dist-info/", name));
  }
  add_files(WEIR_SOURCE_DIR "/bindings/python/weir", cat(folder, "/weir"), files);
#endif
  return files;
}

/// Returns all files of an installation. `python` is the folder for Python modules.
std::set<std::string> installed_files(bool has_cuda, const std::string& python) {
  std::set<std::string> expected{
      "bin/weir",
      "include/weir.h",
      "lib/libweir.so",
      "lib/libweir.so." WEIR_ABI,
      "lib/libweir.so." WEIR_VERSION,
      "lib/libweir_format_core.a",
      "lib/libweir_gpu_core.a",
      "lib/weir/weir_hdf5.so",
      "lib/weir/weir_openvdb.so",
      "lib/weir/weir_plot.so",
      "lib/cmake/weir/weirCTargets.cmake",
      "lib/cmake/weir/weirCTargets-release.cmake",
      "lib/cmake/weir/weirConfig.cmake",
      "lib/cmake/weir/weirConfigVersion.cmake",
      "lib/cmake/weir/weirTargets.cmake",
      "lib/cmake/weir/weirTargets-release.cmake",
      "lib/pkgconfig/weir.pc",
      "etc/weir/example.toml",
      "lib/systemd/system/weir@.service",
      "lib/sysusers.d/weir.conf",
      "share/bash-completion/completions/weir",
      "share/fish/vendor_completions.d/weir.fish",
      "share/zsh/vendor-completions/_weir",
      "share/weir/sidecar.schema.json",
      "share/doc/weir/README.md",
      "share/doc/weir/CHANGELOG.md",
      "share/doc/weir/CONTRIBUTING.md",
      "share/doc/weir/LICENSE",
      "share/doc/weir/format/FORMAT.md",
      "share/doc/weir/format/sidecar.schema.json",
  };
  expected.merge(headers());
  expected.merge(python_files(python));
  if (has_cuda) expected.merge(cuda_files());
  add_files(WEIR_SOURCE_DIR "/docs", "share/doc/weir/docs", expected);
  add_files(WEIR_SOURCE_DIR "/examples", "share/doc/weir/examples", expected);
  const TemporaryDirectory pages;
  EXPECT_EQ(run_weir({"man", pages.path()}).exit_code, 0);
  for (const std::string& page : list_directory(pages.path())) {
    expected.insert(cat("share/man/man", page.back(), '/', page, ".gz"));
  }
  return expected;
}

std::set<std::string> files_below(const fs::path& root) {
  std::set<std::string> files;
  for (const std::string& path : list_directory(root)) {
    if (!path.ends_with('/')) files.insert(path);
  }
  return files;
}

TEST_F(Installation, InstallsExactlyTheListedFiles) {
  EXPECT_EQ(files_below(prefix()), installed_files(has_cuda(), kPythonFolder));
}

TEST_F(Installation, DebianPackageHasTheSameFiles) {
  for (const char* program : {"dpkg-shlibdeps", "file"}) {
    if (run_command({"sh", "-c", cat("command -v ", program)}).exit_code != 0) {
      GTEST_SKIP() << program << " is not installed";
    }
  }
  const TemporaryDirectory work;
  const CommandResult packed = run_command({"sh", "-c", "umask 077; exec \"$0\" \"$@\"", WEIR_CPACK, "--config",
                                            WEIR_INSTALLS "/CPackConfig.cmake", "-B", work.path()});
  ASSERT_EQ(packed.exit_code, 0) << packed.out << packed.err;
  const std::string architecture = run_command({"dpkg", "--print-architecture"}).out;
  const std::string package =
      work / cat("weir_" WEIR_VERSION "_", architecture.substr(0, architecture.size() - 1), ".deb");
  ASSERT_EQ(run_command({"dpkg-deb", "--extract", package, work / "content"}).exit_code, 0);

  for (const std::string& line : split(run_command({"dpkg-deb", "--contents", package}).out, '\n')) {
    EXPECT_TRUE(line.empty() || line[7] == 'r') << "not for all: " << line;
  }
  std::set<std::string> expected = installed_files(has_cuda(), "lib/python3/dist-packages");
  expected.erase("share/doc/weir/LICENSE");  // Debian has the text already, and requires these two files:
  expected.insert({"share/doc/weir/changelog.gz", "share/doc/weir/copyright"});
  std::set<std::string> found;
  for (const std::string& path : files_below(work / "content")) {
    found.insert(path.starts_with("usr/") ? path.substr(4) : path);
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(run_command({work / "content/usr/bin/weir", "--version"}).out, WEIR_VERSION "\n");
  const std::string unit = read_file(work / "content/usr/lib/systemd/system/weir@.service");
  EXPECT_EQ(unit, read_file(WEIR_SOURCE_DIR "/daemon/weir@.service")) << "written for /usr";
  EXPECT_EQ(run_command({"dpkg-deb", "--info", package, "triggers"}).out, "activate-noawait ldconfig\n");
  EXPECT_EQ(run_command({"dpkg-deb", "--info", package, "conffiles"}).out, "/etc/weir/example.toml\n");
  const std::string needs = run_command({"dpkg-deb", "--field", package, "Depends"}).out;
  for (const char* library : {"libc6 (", "libhdf5-", "libopenvdb", "libtbb", "libsqlite3-0"}) {
    EXPECT_NE(needs.find(library), std::string::npos) << needs;
  }
}

TEST_F(Installation, TheCommandRuns) {
  const std::string weir = prefix() + "/bin/weir";
  EXPECT_EQ(run_command({weir, "--version"}).out, WEIR_VERSION "\n");
  const TemporaryDirectory work;
  const std::string raw = work / "a_40x30x20_float32.raw";
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"sample", "cloud", "-o", raw},
                                             {"convert", raw, "--lossless", "-o", work / "a.nvdb"},
                                             {"verify", work / "a.nvdb"},
                                             {"render", work / "a.nvdb", "-o", work / "a.png", "--size", "20x20"}}) {
    std::vector<std::string> all{weir};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = run_command(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
}

// The installation is moved, like an unpacked archive. No path may lead to the build any more.
TEST_F(Installation, ProgramsFindTheDriversBesideThem) {
  const TemporaryDirectory work;
  const std::string moved = work / "opt";
  fs::copy(prefix(), moved, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  const std::string grid = work / "a.nvdb";
  const std::string raw = work / "a_40x30x20_float32.raw";
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"sample", "cloud", "-o", raw},
                                             {"convert", raw, "--lossless", "-o", grid},
                                             {"export", grid, "-o", work / "a.vdb"},
                                             {"convert", work / "a.vdb", "--lossless", "-o", work / "b.nvdb"},
                                             {"inspect", grid, "--plot", work / "a.svg"}}) {
    std::vector<std::string> all{moved + "/bin/weir"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    CommandOptions options;
    options.environment = {"LD_DEBUG=libs", cat("LD_DEBUG_OUTPUT=", work / "loaded")};
    const CommandResult result = run_command(all, options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  std::string loaded;
  for (const std::string& name : list_directory(work.path())) {
    if (name.starts_with("loaded.")) loaded += read_file(work / name);
  }
  for (const char* driver : {"/bin/../lib/weir/weir_openvdb.so", "/bin/../lib/weir/weir_plot.so"}) {
    EXPECT_NE(loaded.find("calling init: " + moved + driver), std::string::npos) << driver;
  }
  if (kPythonFolder.empty()) return;
  CommandOptions options;
  options.environment = {"PYTHONPATH=" + moved + '/' + kPythonFolder};
  const std::string script = "import sys, weir; weir.convert(sys.argv[1], sys.argv[2], lossless=True)";
  const CommandResult result = run_command({kPython, "-B", "-c", script, work / "a.vdb", work / "c.nvdb"}, options);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_file(work / "c.nvdb"), read_file(work / "b.nvdb"));
}

TEST_F(Installation, PythonFindsTheModule) {
  if (kPythonFolder.empty()) GTEST_SKIP() << "the Python module is not built";
  CommandOptions options;
  options.environment = {"PYTHONPATH=" + prefix() + '/' + kPythonFolder};
  const std::string import = "import weir; print(weir.__version__, weir.__file__)";
  const CommandResult result = run_command({kPython, "-B", "-c", import}, options);
  EXPECT_EQ(result.out, cat(WEIR_VERSION, ' ', prefix(), '/', kPythonFolder, "/weir/__init__.py\n")) << result.err;
}

TEST_F(Installation, SystemdUnitNamesTheInstallPrefix) {
  const std::string unit = read_file(prefix() + "/lib/systemd/system/weir@.service");
  EXPECT_NE(unit.find(cat("\nExecStart=", prefix(), "/bin/weir watch /etc/weir/%i.toml\n")), std::string::npos) << unit;
  EXPECT_NE(unit.find(cat("file://", prefix(), "/share/doc/weir/docs/operations.md\n")), std::string::npos);
  EXPECT_EQ(unit.find("/usr/"), std::string::npos);
}

TEST_F(Installation, SystemdFindsNoFaultInTheUnit) {
  if (std::system("command -v systemd-analyze >/dev/null") != 0) GTEST_SKIP() << "systemd-analyze is not installed";
  // Without --man=no, systemd-analyze would look for the manual in the system's own folders.
  const CommandResult result =
      run_command({"systemd-analyze", "verify", "--man=no", prefix() + "/lib/systemd/system/weir@.service"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Installation, LinksOfTheDocumentsPointToInstalledFiles) {
  const fs::path documents = prefix() + "/share/doc/weir";
  const std::regex link("\\]\\(([^)#:]+)(#[^)]*)?\\)");
  std::size_t links = 0;
  for (const std::string& name : list_directory(documents)) {
    if (!name.ends_with(".md") || name == "docs/internals.md") continue;  // docs/internals.md leads through the sources
    const std::string text = read_file(documents / name);
    for (auto at = std::sregex_iterator(text.begin(), text.end(), link); at != std::sregex_iterator(); ++at) {
      if (at->str(1).ends_with(".h")) continue;  // FORMAT.md links to places in the sources
      ++links;
      EXPECT_TRUE(fs::exists((documents / name).parent_path() / at->str(1))) << name << ": " << at->str(1);
    }
  }
  EXPECT_GT(links, 10U);
}

TEST_F(Installation, ManualAndCompletionAreThoseOfTheCommand) {
  const CommandResult page = run_command({"gzip", "-dc", prefix() + "/share/man/man1/weir-convert.1.gz"});
  EXPECT_EQ(page.out.rfind(".TH \"WEIR\\-CONVERT\" 1 \"\" \"weir " WEIR_VERSION "\" \"User Commands\"\n", 0), 0U);
  const std::string share = prefix() + "/share";
  EXPECT_EQ(read_file(share + "/bash-completion/completions/weir"), run_weir({"completion", "bash"}).out);
  EXPECT_EQ(read_file(share + "/zsh/vendor-completions/_weir"), run_weir({"completion", "zsh"}).out);
  EXPECT_EQ(read_file(share + "/fish/vendor_completions.d/weir.fish"), run_weir({"completion", "fish"}).out);
}

TEST_F(Installation, AnotherBuildFindsTheLibraries) {
  const EmbeddedExample example({"-DWEIR_INSTALLED=ON", "-DCMAKE_PREFIX_PATH=" + prefix(), "-DCMAKE_CUDA_COMPILER="});
  const CommandResult sampled = example.run("sample_host", {example.file(), "8", "5.5", "3.25"});
  EXPECT_EQ(sampled.exit_code, 0) << sampled.err;
  EXPECT_EQ(sampled.out, "1207.5\n");
  EXPECT_FALSE(example.has("sample_device"));
}

TEST_F(Installation, AnotherBuildFindsTheDeviceLibrary) {
  if (!has_cuda()) GTEST_SKIP() << "no nvcc";
  const EmbeddedExample example({"-DWEIR_INSTALLED=ON", "-DCMAKE_PREFIX_PATH=" + prefix(),
                                 "-DCMAKE_CUDA_COMPILER=" WEIR_NVCC, "-DCMAKE_CUDA_ARCHITECTURES=90"});
  EXPECT_TRUE(example.has("sample_device"));
}

TEST_F(Installation, HeadersOfWeirInInstalledOnes_AreInstalledToo) {
  const std::regex include("#include \"([^\"]+)\"");
  for (const std::string& header : headers()) {
    const std::string text = read_file(cat(prefix(), "/", header));
    for (std::sregex_iterator found(text.begin(), text.end(), include), end; found != end; ++found) {
      EXPECT_TRUE(fs::exists(cat(prefix(), "/include/weir/", found->str(1)))) << header << ": " << found->str(1);
    }
  }
}

// Each header is compiled alone, so that no header relies on the includes of another one.
TEST_F(Installation, EveryHeaderCompilesAlone) {
  const TemporaryDirectory work;
  for (const std::string& header : headers()) {
    const std::string name = header.substr(std::string("include/weir/").size());
    write_file(work / "a.cpp", cat("#include \"", name, "\"\n"));
    const CommandResult compiled = run_command({WEIR_CXX, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror",
                                                "-I" + prefix() + "/include/weir", work / "a.cpp"});
    EXPECT_EQ(compiled.exit_code, 0) << name << '\n' << compiled.err;
  }
}

TEST(Changelog, NamesTheVersionFirst) {
  const std::string text = read_file(WEIR_SOURCE_DIR "/CHANGELOG.md");
  const std::size_t heading = text.find("\n## [" WEIR_VERSION "] - 20");
  ASSERT_NE(heading, std::string::npos) << "CMakeLists.txt has version " WEIR_VERSION;
  const std::string before = text.substr(0, heading);
  EXPECT_TRUE(before.find("\n## ") == std::string::npos || before.find("\n## [Unreleased]") == before.rfind("\n## "));
}

}  // namespace
}  // namespace weir::install_test

#endif
