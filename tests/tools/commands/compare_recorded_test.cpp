// Tests that weir compare reads the source with the options that the sidecar records.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/tools/support/converted_pair.h"

namespace weir::compare_recorded_test {
namespace {

TEST(CompareRecorded, RegionOfTheConversion_IsTakenFromTheSidecar) {
  const ConvertedPair region("noise", "60x50x40_float32", {"--lossless", "--roi", "3:-10,:,-9:"});
  const CommandResult compared = run_weir({"compare", region.raw, region.nvdb});
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_EQ(compared.out, "lossless: all 21150 finite voxels read bit for bit\n");  // 47 x 50 x 9
  const std::string told = region.raw + ": read with --roi 3:50,0:50,31:40, as " + region.nvdb + ".json records\n";
  EXPECT_TRUE(compared.err.ends_with(" info " + told)) << compared.err;
  EXPECT_EQ(run_weir({"compare", region.raw, region.nvdb, "--roi", "0:60,0:50,0:40"}).exit_code, 3)
      << "what is given counts";
}

TEST(CompareRecorded, SidecarThatSaysNothing_IsWarnedOf) {
  const ConvertedPair volume("noise", "20x10x9_float32", {"--lossless"});
  const ConvertedPair other("noise", "20x10x8_float32", {"--lossless"});
  const std::string sidecar = volume.nvdb + ".json";
  const std::string rest = "; the source is read without what it records\n";
  write_file(sidecar, "{");
  const CommandResult damaged = run_weir({"compare", volume.raw, volume.nvdb});
  EXPECT_EQ(damaged.exit_code, 0);
  EXPECT_NE(damaged.err.find(" warning " + sidecar + ": at byte "), std::string::npos) << damaged.err;
  EXPECT_NE(damaged.err.find(rest), std::string::npos) << damaged.err;
  write_file(sidecar, read_file(other.nvdb + ".json"));
  const CommandResult foreign = run_weir({"compare", volume.raw, volume.nvdb});
  EXPECT_NE(foreign.err.find(sidecar + ": is of another volume than " + volume.nvdb + rest), std::string::npos)
      << foreign.err;
  std::filesystem::remove(sidecar);
  EXPECT_EQ(run_weir({"compare", volume.raw, volume.nvdb}).err, "");
}

TEST(CompareRecorded, IndexOfTheConversion_IsTakenFromTheSidecar) {
  const TemporaryDirectory directory;
  std::string values(5 * 4 * 3 * 2, '\0');
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<char>(i);
  const std::string nrrd = directory / "a.nrrd";
  write_file(nrrd, "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 5 4 3 2\nencoding: raw\n\n" + values);
  const std::string volume = directory / "a.nvdb";
  ASSERT_EQ(run_weir({"convert", nrrd, "--index", "-1", "-o", volume, "--lossless"}).exit_code, 0);
  const CommandResult compared = run_weir({"compare", nrrd, volume});
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_EQ(compared.out, "lossless: all 60 finite voxels read bit for bit\n");
  const CommandResult other = run_weir({"compare", nrrd, volume, "--index", "0", "--json"});
  EXPECT_EQ(nlohmann::json::parse(other.out)["different"], 60);
  EXPECT_TRUE(other.err.ends_with(cat(" warning ", volume, ": was converted with --index 1, as ", volume,
                                      ".json records, and is compared with --index 0\n")))
      << other.err;
  EXPECT_EQ(run_weir({"compare", nrrd, volume, "--index", "1"}).err, "");
}

TEST(CompareRecorded, HowARawFileWasRead_IsTakenFromTheSidecar) {
  const TemporaryDirectory directory;
  std::string values(8, '\0');  // a header of 8 bytes before the volume's values
  for (int i = 0; i < 60; ++i) values += std::string(1, static_cast<char>(i / 8)) + static_cast<char>(31 * i);
  const std::string raw = directory / "dump.bin";
  const std::string volume = directory / "a.nvdb";
  write_file(raw, values);
  const CommandResult converted = run_weir({"convert", raw, "--dims", "5,4,3", "--type", "uint16", "--endian", "big",
                                            "--offset", "8", "-o", volume, "--lossless"});
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  const CommandResult compared = run_weir({"compare", raw, volume});
  EXPECT_EQ(compared.out, "lossless: all 60 finite voxels read bit for bit\n") << compared.err;
  EXPECT_TRUE(compared.err.ends_with(cat(
      " info ", raw, ": read with --dims 5,4,3 --type uint16 --endian big --offset 8, as ", volume, ".json records\n")))
      << compared.err;
  EXPECT_NE(run_weir({"compare", raw, volume, "--endian", "little"}).out, compared.out) << "what is given counts";
  EXPECT_NE(run_weir({"compare", raw, volume, "--type", "<u2"}).out, compared.out) << "its byte order, too";
  EXPECT_EQ(run_weir({"compare", raw, volume, "--type", ">u2"}).out, compared.out);
}

TEST(CompareRecorded, ByteOrderOfAFileWhoseNameSaysTheRest_IsTakenFromTheSidecar) {
  const TemporaryDirectory directory;
  std::string values;
  for (int i = 0; i < 60; ++i) values += std::string(1, static_cast<char>(i / 8)) + static_cast<char>(31 * i);
  const std::string raw = directory / "a_5x4x3_uint16.raw";
  const std::string volume = directory / "a.nvdb";
  write_file(raw, values);
  for (const std::vector<std::string>& order :
       std::vector<std::vector<std::string>>{{"--endian", "big"}, {"--type", ">u2"}}) {
    std::vector<std::string> convert{"convert", raw, "-o", volume, "--lossless", "--overwrite"};
    convert.insert(convert.end(), order.begin(), order.end());
    const CommandResult converted = run_weir(convert);
    ASSERT_EQ(converted.exit_code, 0) << converted.err;
    EXPECT_EQ(run_weir({"compare", raw, volume}).out, "lossless: all 60 finite voxels read bit for bit\n") << order[0];
  }
}

TEST(CompareRecorded, StackOfTheConversion_IsTakenFromTheSidecar) {
  const TemporaryDirectory directory;
  for (int z = 0; z < 3; ++z) write_file(directory / cat("plane_0", z, ".raw"), std::string(20, static_cast<char>(z)));
  const std::string pattern = directory / "plane_%02d.raw";
  const std::string volume = directory / "a.nvdb";
  const CommandResult converted =
      run_weir({"convert", "--stack", pattern, "--dims", "5,4,1", "--type", "uint8", "-o", volume, "--lossless"});
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  const CommandResult compared = run_weir({"compare", pattern, volume});
  EXPECT_EQ(compared.out, "lossless: all 60 finite voxels read bit for bit\n") << compared.err;
  EXPECT_NE(compared.err.find(": read with --stack --dims 5,4,1 --type uint8, as "), std::string::npos) << compared.err;
}

TEST(CompareRecorded, SourceOfAnotherTime_IsSaid) {
  const ConvertedPair volume("noise", "20x10x9_float32", {"--lossless"});
  const std::filesystem::path source = volume.raw;
  std::filesystem::last_write_time(source, std::filesystem::last_write_time(source) + std::chrono::seconds(3));
  const CommandResult later = run_weir({"compare", volume.raw, volume.nvdb});
  EXPECT_NE(later.err.find(cat(volume.raw, ": is of 20")), std::string::npos) << later.err;
  EXPECT_NE(later.err.find(cat(" when it was converted, as ", volume.nvdb,
                               ".json records; the figures compare with what it is now\n")),
            std::string::npos)
      << later.err;
}

}  // namespace
}  // namespace weir::compare_recorded_test
