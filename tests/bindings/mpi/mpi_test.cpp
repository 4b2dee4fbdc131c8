// Conversions by several processes: weir-mpi and the pushes of weir_mpi.h, against what one process makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "bindings/c/weir.h"
#include "format/base/text.h"
#include "tests/bindings/mpi/run_mpi.h"
#include "tests/support/temporary_directory.h"

namespace weir::mpi_test {
namespace {

namespace fs = std::filesystem;

const std::string kData = WEIR_SOURCE_DIR "/../shared/data/";

std::vector<std::string> sorted_lines(const std::string& text) {
  std::vector<std::string> lines = split(text, '\n');
  std::sort(lines.begin(), lines.end());
  return lines;
}

class Mpi : public testing::Test {
 protected:
  std::string sample(const std::string& kind, const std::string& dims, const std::string& type) {
    std::string name = kind + "_" + dims + "_" + type + ".raw";
    std::string commas = dims;
    for (char& c : commas) c = c == 'x' ? ',' : c;
    const CommandResult made =
        run_weir({"sample", kind, "--dims", commas, "--type", type, "-o", name, "--log-level", "error"}, here());
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return name;
  }

  // One of ../shared/data; empty where it is missing.
  std::string real(const std::string& name) {
    const std::string packed = kData + name + ".xz";
    if (!fs::exists(packed)) return "";
    const CommandResult raw = run_command({"sh", "-c", "xz -dkc '" + packed + "' > " + name}, here());
    EXPECT_EQ(raw.exit_code, 0) << raw.err;
    return name;
  }

  std::string serial(const std::string& volume, std::vector<std::string> options) {
    std::vector<std::string> command{"convert", volume, "-o", "serial.nvdb", "--overwrite", "--log-level", "error"};
    command.insert(command.end(), options.begin(), options.end());
    const CommandResult made = run_weir(command, here());
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return read_file(directory_ / "serial.nvdb");
  }

  // With 1, 2, 3 and 8 processes.
  void expect_same(const std::string& volume, const std::vector<std::string>& options) {
    const std::string expected = serial(volume, options);
    for (const int processes : {1, 2, 3, 8}) {
      std::vector<std::string> command{WEIR_MPI_COMMAND, "convert", volume, "-o", "mpi.nvdb", "--overwrite"};
      command.insert(command.end(), options.begin(), options.end());
      const CommandResult made = run_mpi(processes, command, directory_.path());
      ASSERT_EQ(made.exit_code, 0) << made.err;
      EXPECT_TRUE(read_file(directory_ / "mpi.nvdb") == expected)
          << volume << ", " << processes << " processes, " << options.back();
    }
    const CommandResult verified = run_weir({"verify", "mpi.nvdb"}, here());
    EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  }

  CommandResult push(int processes, const std::string& volume, const std::vector<std::string>& extent_and_type,
                     const std::vector<std::string>& budget, const std::string& mode) {
    std::vector<std::string> command{WEIR_MPI_PUSH, volume};
    command.insert(command.end(), extent_and_type.begin(), extent_and_type.end());
    command.emplace_back("pushed.nvdb");
    command.insert(command.end(), budget.begin(), budget.end());
    command.push_back(mode);
    return run_mpi(processes, command, directory_.path());
  }

  // What serial conversion makes of it, pushed by 1, 2, 3 and 8 processes.
  void expect_pushed(const std::string& volume, const std::vector<std::string>& extent_and_type) {
    expect_pushed(volume, extent_and_type, {"--rate", "6"}, {cat(WEIR_BUDGET_RATE), "6"});
  }
  void expect_pushed(const std::string& volume, const std::vector<std::string>& extent_and_type,
                     std::vector<std::string> options, const std::vector<std::string>& budget) {
    options.insert(options.end(), {"--nonfinite", "background"});
    const std::string expected = serial(volume, options);
    for (const int processes : {1, 2, 3, 8}) {
      fs::remove(directory_ / "pushed.nvdb");
      fs::remove(directory_ / "pushed.nvdb.json");
      const CommandResult pushed = push(processes, volume, extent_and_type, budget, "all");
      ASSERT_EQ(pushed.exit_code, 0) << pushed.err;
      ASSERT_EQ(pushed.out, "end: 0 \nafter: the push has ended; begin another\n");
      EXPECT_TRUE(read_file(directory_ / "pushed.nvdb") == expected) << volume << ", " << processes << " processes";
    }
  }

  std::vector<std::string> leftovers() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(directory_.path())) {
      const std::string name = entry.path().filename();
      if (name.find("nvdb") != std::string::npos || name.starts_with('.')) names.push_back(name);
    }
    return names;
  }

  CommandOptions here() const {
    CommandOptions options;
    options.directory = directory_.path();
    return options;
  }

  TemporaryDirectory directory_;
};

std::string gradient_of(const std::string& sidecar) {
  const std::size_t at = sidecar.find("\"gradient\":{");
  return at == std::string::npos ? "none" : sidecar.substr(at, sidecar.find('}', at) - at);
}

TEST_F(Mpi, CertifiesTheGradientThatOneProcessDoes) {
  const std::string volume = sample("turbulence", "140x130x134", "float32");
  const std::vector<std::string> options{"--rate", "6", "--certify", "gradient"};
  expect_same(volume, options);
  const std::string certified = gradient_of(read_file(directory_ / "serial.nvdb.json"));
  EXPECT_NE(certified, "none");
  EXPECT_EQ(gradient_of(read_file(directory_ / "mpi.nvdb.json")), certified);
}

TEST_F(Mpi, AnyNumberOfProcessesConvertsToTheSameBytes) {
  const std::string cloud = sample("cloud", "150x140x270", "float32");
  expect_same(cloud, {"--rate", "8"});
  expect_same(cloud, {"--encoding", "float", "--rate", "5"});
  expect_same(cloud, {"--preset", "paper", "--rate", "4"});
  expect_same(cloud, {"--lossless"});
  const std::string turbulence = sample("turbulence", "257x130x33", "float32");
  expect_same(turbulence, {"--psnr", "45"});
  expect_same(turbulence, {"--max-error", "0.05"});
  expect_same(turbulence, {"--metric", "farthest", "--rate", "4"});
  expect_same(sample("cloud", "1x1x1", "uint8"), {"--lossless"});
}

TEST_F(Mpi, PackedConversionsGiveTheSameBytes) {
  const std::string turbulence = sample("turbulence", "167x143x119", "float32");
  expect_same(turbulence, {"--encoding", "packed", "--rate", "20"});
  expect_same(turbulence, {"--encoding", "packed", "--psnr", "135"});
  expect_same(turbulence, {"--encoding", "packed", "--max-error", "0.001"});
  // Blocks with missing values are read once more.
  const std::string missing = sample("some-nan", "167x143x119", "float32");
  expect_same(missing, {"--encoding", "packed", "--nonfinite", "background", "--rate", "4"});
  expect_pushed(missing, {"167", "143", "119", "10"});
}

TEST_F(Mpi, ConversionWithAScene_GivesTheSameBytes) {
  const std::string cloud = sample("cloud", "150x140x140", "float32");
  write_file(directory_ / "scene.toml",
             "[volume]\nrange = [0.0, 1.0]\nopacity = [[0.0, 0.0], [0.4, 0.0], [1.0, 1.0]]\n");
  expect_same(cloud, {"--rate", "30", "--scene", "scene.toml"});
  expect_same(cloud, {"--encoding", "packed", "--rate", "60", "--scene", "scene.toml"});
}

TEST_F(Mpi, RealVolumesConvertAndPushToTheSameBytes) {
  const std::string aneurism = real("aneurism_256x256x256_uint8.raw");
  const std::string brain = real("mni152_2009_193x229x193_int16.raw");
  const std::string vortices = real("wmag_91x91x91_float32.raw");
  if (aneurism.empty() || brain.empty() || vortices.empty()) GTEST_SKIP() << kData << " is missing";
  expect_same(aneurism, {"--rate", "10"});
  expect_same(brain, {"--rate", "10"});
  expect_pushed(aneurism, {"256", "256", "256", "1"});
  expect_pushed(brain, {"193", "229", "193", "4"});
  expect_pushed(vortices, {"91", "91", "91", "10"});
}

TEST_F(Mpi, HardVolumesPushToTheSameBytes) {
  const auto expect_all_of = [&](const std::string& kind, const std::string& dims, const std::string& type,
                                 const std::vector<std::string>& extent_and_type) {
    expect_pushed(sample(kind, dims, type), extent_and_type, {"--lossless"}, {cat(WEIR_BUDGET_LOSSLESS), "0"});
  };
  expect_all_of("some-nan", "129x40x33", "float32", {"129", "40", "33", "10"});
  expect_all_of("cloud", "1x1x1", "float64", {"1", "1", "1", "11"});
  expect_all_of("turbulence", "7x9x17", "int16", {"7", "9", "17", "4"});
}

TEST_F(Mpi, AFailureIsOneLineAndTheSameEverywhere) {
  const std::string cloud = sample("cloud", "64x64x200", "float32");
  const auto fails = [&](const std::vector<std::string>& arguments, int code, const std::string& line) {
    std::vector<std::string> command{WEIR_MPI_COMMAND, "convert"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const CommandResult run = run_mpi(3, command, directory_.path());
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_EQ(line_of(run.err, "weir-mpi"), line) << run.err;
  };
  const std::string missing =
      "none.raw: cannot open for reading: No such file or directory; check the name and the current directory";
  fails({"none.raw", "-o", "out.nvdb"}, 3, "weir-mpi: " + missing);
  fails({"no\nne.raw", "-o", "out.nvdb"}, 3, "weir-mpi: no\\n" + missing.substr(2));
  fails({cloud, "-o", "none/out.nvdb"}, 5,
        "weir-mpi: none/out.nvdb: the directory none does not exist; make it or choose another output");
  fails(
      {cloud, "-o", "out.nvdb", "--size", "1000"}, 4,
      "weir-mpi: out.nvdb: 1000 bytes asked, the smallest tree for this volume takes 345312; ask for --size 345312 or "
      "more");
  fails({cloud, "-o", "out.nvdb", "--speed", "9"}, 2, "weir-mpi: no option --speed; see weir-mpi convert --help");
  fails({cloud, "-o", "out.nvdb", "--sizee", "9"}, 2,
        "weir-mpi: no option --sizee; did you mean --size? see weir-mpi convert --help");
  fails({cloud, "-o=out.nvdb"}, 2,
        "weir-mpi: -o=out.nvdb is read as the name =out.nvdb; write -o NAME or --output=NAME");
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
  write_file(directory_ / "out.nvdb", "theirs");
  fails({cloud, "-o", "out.nvdb"}, 2, "weir-mpi: out.nvdb: exists; choose another output or pass --overwrite");
  EXPECT_EQ(read_file(directory_ / "out.nvdb"), "theirs");
}

TEST_F(Mpi, SidecarThatStdoutDoesNotTake_ExitsWith5) {
  const std::string cloud = sample("cloud", "20x30x40", "float32");
  const std::string convert = cat("exec '", WEIR_MPI_COMMAND, "' convert ", cloud, " -o mpi.nvdb --lossless --json ");
  const CommandResult full = run_mpi(1, {"sh", "-c", convert + "> /dev/full"}, directory_.path());
  EXPECT_EQ(full.exit_code, 5) << full.err;
  EXPECT_EQ(line_of(full.err, "weir-mpi"),
            "weir-mpi: stdout: cannot write: No space left on device; free space there or redirect it to another file")
      << full.err;
  // A reader that has gone is no error.
  const CommandResult gone =
      run_mpi(1, {"sh", "-c", "{ sleep 1; (" + convert + "--overwrite); echo $? > code; } | true"}, directory_.path());
  EXPECT_EQ(read_file(directory_ / "code"), "0\n") << gone.err;
}

// As on two machines that do not share the directory: the second process works in another one.
TEST_F(Mpi, AFileThatSomeProcessDoesNotFindLeavesNothing) {
  const std::string cloud = directory_ / sample("cloud", "64x64x200", "float32");
  const auto run_apart = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command{WEIR_MPI_COMMAND, "convert", cloud};
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::string again = "cd other && exec";
    for (const std::string& word : command) again += " '" + word + "'";
    command.insert(command.end(), {":", "-n", "1", "sh", "-c", again});
    return run_mpi(1, command, directory_.path());
  };
  fs::create_directories(directory_ / "other/work");
  fs::create_directory(directory_ / "work");
  const CommandResult output = run_apart({"-o", "out.nvdb"});
  EXPECT_EQ(output.exit_code, 5) << output.err;
  const std::string missing =
      ": process 1 of 2 does not find what process 0 made; output and work directory must be on a file system that all "
      "processes share";
  EXPECT_EQ(line_of(output.err, "weir-mpi"), "weir-mpi: out.nvdb.partial" + missing) << output.err;
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
  const CommandResult work = run_apart({"-o", directory_ / "out.nvdb", "--work-dir", "work"});
  EXPECT_EQ(work.exit_code, 5) << work.err;
  const std::string said = line_of(work.err, "weir-mpi");
  EXPECT_TRUE(said.starts_with("weir-mpi: work/.weir.") && said.ends_with(missing)) << work.err;
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
  EXPECT_TRUE(fs::is_empty(directory_ / "work"));
}

TEST_F(Mpi, PushOfMissingOrRepeatedVoxels_IsRefused) {
  const std::string cloud = sample("cloud", "20x30x40", "float32");
  const std::vector<std::string> volume{"20", "30", "40", "10"};
  const auto refused = [&](const std::string& mode, const std::string& said) {
    const CommandResult run = push(3, cloud, volume, {"1", "6"}, mode);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(sorted_lines(run.out), sorted_lines(said)) << mode;  // those of several processes come as they come
    EXPECT_EQ(leftovers(), std::vector<std::string>{}) << mode;
  };
  refused("missing", "end: 2 memory: 1000 voxels are missing, those of 10:20,20:30,30:40 first\n");
  refused("twice", "end: 2 memory: voxels of the box 10:20,20:30,30:40 were given twice; give each voxel once\n");
  refused("outside",
          "box: 2 memory: a box of voxels 10:20,20:30,31:41 is not in the volume of 20x30x40\n"
          "end: 2 memory: 1000 voxels are missing, those of 10:20,20:30,30:40 first\n");
  const std::string remedy = "; give all processes the same volume, options and output\n";
  refused("differing",
          "begin: 2 memory: process 2 of 3 has extent 20,30,39 where process 0 has extent 20,30,40" + remedy);
  refused("elsewhere", "begin: 2 memory: process 2 of 3 has origin 100,0,0 where process 0 has origin 0,0,0" + remedy);
  refused("memory", "begin: 2 memory 1 B is too small for this volume with 1 thread; give at least 19MiB\n");
  refused("options", cat("begin: 2 weir_convert_options: struct_size is 0, and must be at least ",
                         offsetof(weir_convert_options, preview), "; set it up with weir_convert_options_init\n"));
  refused("null",
          "box: 2 data is a null pointer\n"
          "end: 2 memory: 1000 voxels are missing, those of 10:20,20:30,30:40 first\n");
}

TEST_F(Mpi, PushOfABoxWithStridesOutOfTheAddressSpace_IsRefusedAndGoesOn) {
  const CommandResult run = push(3, sample("cloud", "20x30x40", "float32"), {"20", "30", "40", "10"},
                                 {cat(WEIR_BUDGET_LOSSLESS), "0"}, "strides");
  EXPECT_EQ(
      sorted_lines(run.out),
      sorted_lines("box: 2 memory: a stride of 2305843009213693951 bytes along z for 10 voxels leaves the address "
                   "space; strides are in bytes\n"
                   "end: 0 \nafter: the push has ended; begin another\n"))
      << run.err;
}

TEST_F(Mpi, PushThatOneProcessCancels_IsInterruptedInAll) {
  const CommandResult run =
      push(3, sample("cloud", "20x30x40", "float32"), {"20", "30", "40", "10"}, {"1", "6"}, "cancelled");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(sorted_lines(run.out),
            sorted_lines("box: 130 interrupted; nothing was written\nend: 130 interrupted; nothing was written\n"));
  EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

// As `weir convert --resume on` leaves it where it is killed.
TEST_F(Mpi, WorkOfAnInterruptedConversion_IsRemoved) {
  const std::string cloud = sample("cloud", "20x30x40", "float32");
  const auto leave_work = [&](const std::string& output) {
    const fs::path hidden = directory_ / cat('.', output, ".work");
    fs::create_directory(hidden);
    for (const char* name : {"journal", "rows", "volume"}) write_file(hidden / name, "left");
  };
  for (const int processes : {1, 3}) {
    SCOPED_TRACE(processes);
    leave_work("mpi.nvdb");
    const CommandResult made =
        run_mpi(processes, {WEIR_MPI_COMMAND, "convert", cloud, "-o", "mpi.nvdb", "--lossless"}, directory_.path());
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_NE(made.err.find("mpi.nvdb: what an interrupted conversion of it had left is removed\n"), std::string::npos)
        << made.err;
    leave_work("pushed.nvdb");
    const CommandResult pushed =
        push(processes, cloud, {"20", "30", "40", "10"}, {cat(WEIR_BUDGET_LOSSLESS), "0"}, "all");
    EXPECT_EQ(pushed.out, "end: 0 \nafter: the push has ended; begin another\n") << pushed.err;
    std::vector<std::string> left = leftovers();
    std::sort(left.begin(), left.end());
    EXPECT_EQ(left, (std::vector<std::string>{"mpi.nvdb", "mpi.nvdb.json", "pushed.nvdb", "pushed.nvdb.json"}));
    for (const std::string& name : left) fs::remove_all(directory_ / name);
  }
}

TEST_F(Mpi, NoticeOfTheSource_IsSaidOnce) {
  std::string bytes = serial(sample("cloud", "20x30x40", "float32"), {"--lossless"});
  const std::size_t name = bytes.rfind("density");  // the grid's own, behind that of the file's head
  ASSERT_NE(name, std::string::npos);
  bytes[name] = 'D';
  write_file(directory_ / "changed.nvdb", bytes);
  const CommandResult made =
      run_mpi(3, {WEIR_MPI_COMMAND, "convert", "changed.nvdb", "-o", "mpi.nvdb", "--lossless"}, directory_.path());
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const std::string notice = " has another head than its checksum is of: ";
  EXPECT_NE(made.err.find(notice), std::string::npos) << made.err;
  EXPECT_EQ(made.err.find(notice), made.err.rfind(notice)) << made.err;
}

TEST_F(Mpi, ExampleSavesTheSameBytesForAnyNumberOfProcesses) {
  for (const int processes : {1, 3}) {
    fs::create_directory(directory_ / cat(processes));
    const CommandResult run = run_mpi(processes, {WEIR_MPI_EXAMPLE, cat(processes), "40", "20"}, directory_.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  for (const char* name : {"heat_0000.nvdb", "heat_0020.nvdb"}) {
    const std::string one = read_file(directory_ / cat("1/", name));
    EXPECT_FALSE(one.empty()) << name;
    EXPECT_TRUE(one == read_file(directory_ / cat("3/", name))) << name;
  }
}

TEST_F(Mpi, ExampleInFortranSavesTheBytesOfTheOneInC) {
  const std::string compiler = WEIR_MPI_FORTRAN;
  if (run_command({"sh", "-c", cat("'", compiler, "' --version")}).exit_code != 0) {
    GTEST_SKIP() << "no Fortran compiler behind " << compiler;
  }
  const std::string examples = WEIR_SOURCE_DIR "/examples/";
  const std::string library = WEIR_C_LIBRARY;
  const CommandResult compiled =
      run_command({compiler, "-std=f2008", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off", "-o",
                   "heat_fortran", examples + "push/weir.f90", examples + "mpi/weir_mpi.f90", examples + "mpi/heat.f90",
                   WEIR_MPI_LIBRARY, library, cat("-Wl,-rpath,", library.substr(0, library.rfind('/')))},
                  here());
  ASSERT_EQ(compiled.exit_code, 0) << compiled.err;
  for (const char* name : {"c", "fortran"}) fs::create_directory(directory_ / name);
  const CommandResult c = run_mpi(1, {WEIR_MPI_EXAMPLE, "c", "40", "20"}, directory_.path());
  ASSERT_EQ(c.exit_code, 0) << c.err;
  const CommandResult fortran = run_mpi(3, {directory_ / "heat_fortran", "fortran", "40", "20"}, directory_.path());
  ASSERT_EQ(fortran.exit_code, 0) << fortran.out << fortran.err;
  for (const char* name : {"heat_0000.nvdb", "heat_0020.nvdb"}) {
    EXPECT_TRUE(read_file(directory_ / cat("c/", name)) == read_file(directory_ / cat("fortran/", name))) << name;
  }
  const CommandResult refused = run_mpi(2, {directory_ / "heat_fortran", "none", "40", "20"}, directory_.path());
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_NE(refused.out.find(cat("the directory ", directory_ / "none", " does not exist")), std::string::npos)
      << refused.out << refused.err;
}

TEST(MpiDocument, ShowsTheExampleAsItIs) {
  const std::string text = read_file(WEIR_SOURCE_DIR "/docs/mpi.md");
  const std::size_t begin = text.find("\n```c\n") + 6;
  const std::string shown = text.substr(begin, text.find("\n```\n", begin) - begin);
  ASSERT_GT(shown.size(), 500U);
  EXPECT_NE(read_file(WEIR_SOURCE_DIR "/examples/mpi/heat.c").find(shown), std::string::npos);
}

}  // namespace
}  // namespace weir::mpi_test
