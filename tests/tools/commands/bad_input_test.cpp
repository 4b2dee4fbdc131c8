// Tests how `weir convert` refuses bad input, and that it leaves nothing behind. Each refusal is compared whole: exit
// code, the one line on stderr, an empty stdout, and every directory it could have written to.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <limits>

#include "tests/support/run_command.h"
#include "tests/support/scoped_mount.h"

namespace weir::bad_input_test {
namespace {

namespace fs = std::filesystem;

class BadInput : public ::testing::Test {
 protected:
  BadInput() {
    fs::create_directory(in_);
    fs::create_directory(out_);
  }

  /// Writes a raw volume of `values` to in/NAME.
  std::string volume(const std::string& name, const std::vector<float>& values) {
    std::string bytes(values.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    write_file(in_ / name, bytes);
    return (in_ / name).string();
  }
  std::string bytes(const std::string& name, std::size_t count) {
    write_file(in_ / name, std::string(count, '\1'));
    return (in_ / name).string();
  }
  std::string out() const { return (out_ / "out.nvdb").string(); }

  void expect_refused(const std::vector<std::string>& arguments, int exit_code, const std::string& line) {
    SCOPED_TRACE(line);
    const auto before = list_directory(directory_.path());
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.err, "weir: " + line + "\n");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(list_directory(directory_.path()), before);
  }
  void expect_convert_refused(const std::string& input, std::vector<std::string> options, int exit_code,
                              const std::string& line) {
    options.insert(options.begin(), {"convert", input, "-o", out()});
    expect_refused(options, exit_code, line);
  }

  TemporaryDirectory directory_;
  fs::path in_ = directory_.path() / "in";
  fs::path out_ = directory_.path() / "out";
};

TEST_F(BadInput, MissingFile) {
  const std::string path = (in_ / "none_8x8x8_uint8.raw").string();
  expect_convert_refused(path, {}, 3, path + ": cannot open for reading: No such file or directory");
}

TEST_F(BadInput, Directory) {
  const std::string path = (in_ / "folder_8x8x8_uint8.raw").string();
  fs::create_directory(path);
  expect_convert_refused(path, {}, 3, path + ": is a directory; name a file in it");
}

TEST_F(BadInput, EmptyFile) {
  const std::string path = bytes("empty_8x8x8_uint8.raw", 0);
  expect_convert_refused(path, {}, 3, path + ": is empty (0 bytes); copy it again, or write it anew");
}

TEST_F(BadInput, SizeThatDoesNotMatchDims) {
  const std::string path = bytes("short.raw", 2047);
  const std::string advice = "; check --dims, --type and --offset";
  expect_convert_refused(
      path, {"--dims", "8,8,8", "--type", "float32"}, 3,
      path + ": 1 byte too short: 8x8x8 float32 after an offset of 0 needs 2048 bytes, the file has 2047" + advice);
  expect_convert_refused(
      path, {"--dims", "8,8,8", "--type", "uint16"}, 3,
      path + ": 1023 bytes too long: 8x8x8 uint16 after an offset of 0 needs 1024 bytes, the file has 2047" + advice);
  expect_convert_refused(
      path, {"--dims", "8,8,8", "--type", "uint16", "--offset", "1024"}, 3,
      path + ": 1 byte too short: 8x8x8 uint16 after an offset of 1024 needs 2048 bytes, the file has 2047" + advice);
}

TEST_F(BadInput, DimsThatAreNoExtent) {
  const std::string path = bytes("volume.raw", 512);
  const auto refused = [&](const std::string& dims, int exit_code, const std::string& line) {
    expect_convert_refused(path, {"--dims", dims, "--type", "uint8"}, exit_code, line);
  };
  const auto form = [](const std::string& dims) {
    return "--dims is \"" + dims + "\", it must be X,Y,Z, three whole numbers of voxels";
  };
  for (const char* dims : {"18446744073709551624,8,8", "8,8", "8,8,8,8", "8,8,", "8.5,8,8", "8x8,8", "eight"})
    refused(dims, 2, form(dims));
  for (const char* dims : {"8,0,8", "-8,8,8", "8,8,2147483648"})
    refused(dims, 2, form(dims) + ", each from 1 to 2147483647");
  const std::string all = "2147483647,2147483647,2147483647";
  refused(all, 2, form(all) + ", with fewer than 2^60 voxels together");
}

TEST_F(BadInput, UnknownType) {
  const std::string types =
      "uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, bfloat16, float32, float64";
  expect_convert_refused(bytes("volume.raw", 512), {"--dims", "8,8,8", "--type", "uint7"}, 2,
                         "--type is \"uint7\", it must be one of " + types +
                             ", or float, double, u1, i1, u2, i2, u4, i4, u8, i8, f2, f4, f8, where < or > before the "
                             "name says the byte order");
  const std::string named = bytes("volume_8x8x8_float80.raw", 1024);
  expect_convert_refused(named, {}, 2,
                         named + ": unknown type 'float80' in the file's name; give --type with one of " + types);
  const std::string plain = bytes("plain.raw", 512);
  expect_convert_refused(plain, {"--dims", "8,8,8"}, 2, plain + ": type unknown; give --type with one of " + types);
}

TEST_F(BadInput, NameThatContradictsTheOptions) {
  const std::string path = bytes("volume_8x8x16_uint8.raw", 1024);
  expect_convert_refused(
      path, {"--dims", "16,8,8"}, 2,
      path + ": --dims 16,8,8 contradicts the file's name, which says 8x8x16; drop it or rename the file");
  expect_convert_refused(
      path, {"--type", "int8"}, 2,
      path + ": --type int8 contradicts the file's name, which says uint8; drop it or rename the file");
}

TEST_F(BadInput, NonFiniteValuesByDefault) {
  std::vector<float> values(512, 1.0F);
  values[8 * 8 * 3 + 8 * 2 + 1] = std::numeric_limits<float>::quiet_NaN();
  values[8 * 8 * 5] = std::numeric_limits<float>::infinity();
  values[511] = -std::numeric_limits<float>::infinity();
  const std::string path = volume("nan_8x8x8_float32.raw", values);
  expect_convert_refused(path, {"--lossless"}, 3,
                         path +
                             ": 3 voxels are NaN or infinite, the first (nan) at 1,2,3; choose --nonfinite background "
                             "or --nonfinite keep");
  values.assign(512, 1.0F);
  values[8] = -std::numeric_limits<float>::infinity();
  values[9] = -std::numeric_limits<float>::max();
  expect_convert_refused(volume("inf_8x8x8_float32.raw", values), {"--lossless"}, 3,
                         (in_ / "inf_8x8x8_float32.raw").string() +
                             ": 1 voxel is NaN or infinite, the first (-inf) at 0,1,0; choose --nonfinite background "
                             "or --nonfinite keep");
}

TEST_F(BadInput, BudgetBelowTheMinimumTree) {
  const std::string path = volume("ones_8x8x8_float32.raw", std::vector<float>(512, 1.0F));
  const auto line = [&](const std::string& asked) {
    return out() + ": " + asked +
           " bytes asked, the smallest tree for this volume takes 309664; ask for --size 309664 or more";
  };
  expect_convert_refused(path, {"--size", "1000"}, 4, line("1000"));
  expect_convert_refused(path, {"--size", "309663"}, 4, line("309663"));
  expect_convert_refused(path, {"--rate", "8"}, 4, line("256"));
  EXPECT_EQ(run_weir({"convert", path, "-o", out(), "--size", "309664"}).exit_code, 0);
  EXPECT_EQ(fs::file_size(out()), 309664U);
}

TEST_F(BadInput, OutputDirectoryMissing) {
  const std::string path = bytes("volume_8x8x8_uint8.raw", 512);
  const std::string missing = (out_ / "none").string();
  expect_refused({"convert", path, "-o", missing + "/out.nvdb"}, 5,
                 missing + "/out.nvdb: the directory " + missing + " does not exist; make it or choose another output");
}

TEST_F(BadInput, OutputExists) {
  const std::string path = bytes("volume_8x8x8_uint8.raw", 512);
  const auto line = [](const std::string& existing) {
    return existing + ": exists; choose another output or pass --overwrite";
  };
  write_file(out(), "precious");
  expect_convert_refused(path, {}, 2, line(out()));
  EXPECT_EQ(read_file(out()), "precious");
  fs::rename(out(), out() + ".json");
  expect_convert_refused(path, {}, 2, line(out() + ".json"));
  EXPECT_EQ(read_file(out() + ".json"), "precious");
}

TEST_F(BadInput, OutputIsTheInput) {
  const std::string path = bytes("volume_8x8x8_uint8.raw", 512);
  expect_refused({"convert", path, "-o", path, "--overwrite"}, 2, path + ": is the input; choose another output");
  EXPECT_EQ(read_file(path), std::string(512, '\1'));
}

TEST_F(BadInput, OutputIsADirectory) {
  const std::string path = bytes("volume_8x8x8_uint8.raw", 512);
  expect_refused({"convert", path, "-o", out_.string(), "--overwrite"}, 2,
                 out_.string() + ": is a directory; name a file in it");
}

TEST_F(BadInput, OutputDirectoryReadOnly) {
  const std::string path = bytes("volume_8x8x8_uint8.raw", 512);
  const auto expect_reason = [&](const std::string& reason) {
    expect_convert_refused(
        path, {"--work-dir", in_.string()}, 5,
        out() + ".partial: cannot create: " + reason + "; check the permissions or choose another place");
  };
  if (geteuid() == 0) {  // root may write despite permissions
    ScopedMount mount(out_, 1 << 20);
    if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
    mount.make_read_only();
    expect_reason("Read-only file system");
  } else {
    fs::permissions(out_, fs::perms::owner_read | fs::perms::owner_exec);
    expect_reason("Permission denied");
    fs::permissions(out_, fs::perms::owner_all);
  }
}

TEST_F(BadInput, DiskFull) {
  const ScopedMount mount(out_, 1 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  std::vector<float> values(std::size_t{96} * 96 * 96);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  const std::string path = volume("ramp_96x96x96_float32.raw", values);
  expect_convert_refused(path, {"--size", "2MiB", "--work-dir", in_.string()}, 5,
                         out() +
                             ".partial: cannot reserve 2097152 bytes: No space left on device; free space on that "
                             "file system or choose another with -o or --work-dir");
}

TEST_F(BadInput, WorkDirectoryInMemory) {
  const ScopedMount mount(out_, 1 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  const std::string path = bytes("volume_8x8x8_uint8.raw", 512);
  expect_refused({"convert", path, "-o", (in_ / "out.nvdb").string(), "--work-dir", out_.string()}, 2,
                 "--work-dir " + out_.string() + ": is a memory file system; choose a directory on a disk");
}

TEST_F(BadInput, CommandLine) {
  const std::string path = bytes("volume_8x8x8_uint8.raw", 512);
  expect_refused({}, 2, "no command given; see weir --help");
  expect_refused({"divert"}, 2, "no command \"divert\"; see weir --help");
  expect_refused({"convert"}, 2, "input is required; see weir convert --help");
  expect_convert_refused(path, {"--velocity"}, 2, "no option --velocity; see weir convert --help");
  expect_refused({"covnert", path}, 2, "no command \"covnert\"; did you mean convert? see weir --help");
  expect_refused({"--versoin"}, 2, "no option --versoin; did you mean --version? see weir --help");
  expect_convert_refused(path, {"--lossles"}, 2,
                         "no option --lossles; did you mean --lossless? see weir convert --help");
  expect_convert_refused(path, {"--rte=8"}, 2, "no option --rte; did you mean --rate? see weir convert --help");
  expect_refused({"sample", "cloud", "more", "-o", path + ".raw", "--dims", "8,8,8"}, 2,
                 "unexpected argument \"more\"; see weir sample --help");
  expect_convert_refused(path, {"--rate", "8", "--size", "1MB"}, 2,
                         "--size, --rate, --psnr, --max-error and --lossless exclude each other; give one");
  for (const char* size : {"0", "-5", "12parsecs", "1.5"}) {
    expect_convert_refused(
        path, {"--size", size}, 2,
        "--size is \"" + std::string(size) + "\", it must be a size such as 1048577, 64MiB or 1.5GB");
  }
  for (const char* size : {"9223372036854775808", "4194305TiB", "1e300"}) {
    expect_convert_refused(path, {"--size", size}, 2,
                           "--size is \"" + std::string(size) + "\", it must be a size of at most 2^62 bytes");
  }
  for (const char* rate : {"0", "-8", "nan", "inf", "eight"}) {
    expect_convert_refused(
        path, {"--rate", rate}, 2,
        "--rate is \"" + std::string(rate) + "\", it must be a positive number: dense float32 bytes / file bytes");
  }
}

}  // namespace
}  // namespace weir::bad_input_test
