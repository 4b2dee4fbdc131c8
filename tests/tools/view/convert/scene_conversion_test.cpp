#include "tools/view/convert/scene_conversion.h"

#include <chrono>
#include <filesystem>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/tools/support/converted_volume.h"

namespace weir::scene_conversion_test {
namespace {

class SceneConversionTest : public ConvertedVolume {};

TEST_F(SceneConversionTest, CommandThatIsShown_IsFitForAShell) {
  const std::string volume = directory_ / "it's a $(file).nvdb";
  const std::string source = directory_ / "it's a `source`.raw";
  std::filesystem::copy(volume_, volume);
  const std::string original = directory_ / "v_40x30x20_float32.raw";
  std::filesystem::copy(original, source);
  std::filesystem::last_write_time(source, std::filesystem::last_write_time(original));
  Sidecar said = sidecar();
  said.source.path = source;
  said.weir.options = {{"dims", "40,30,20"}, {"type", "float32"}};
  ConvertRequest request;
  request.encoding = "auto";
  request.rate = 2.5;
  const SceneConversion conversion = scene_conversion(volume, "", said, request);
  EXPECT_EQ(conversion.output, directory_ / "it's a $(file)_scene.nvdb");
  ConvertRequest by_error = request;
  by_error.rate.reset();
  by_error.psnr_db = 50;
  const std::string text = scene_conversion(volume, "", said, by_error).text;
  EXPECT_NE(text.find(" --psnr 50 -o "), std::string::npos) << text;
  EXPECT_EQ(text.find("--rate"), std::string::npos) << text;
  // A shell splits the text into exactly these words.
  const CommandResult shell = run_command({"/bin/sh", "-c", "weir() { printf '%s\\n' \"$@\"; }; " + conversion.text});
  EXPECT_EQ(shell.exit_code, 0) << shell.err;
  std::string words;
  for (const std::string& word : conversion.arguments) words += word + '\n';
  EXPECT_EQ(shell.out, words);
  EXPECT_EQ(conversion_command(conversion, "s.toml").front(), "weir");
  EXPECT_EQ(conversion_command(conversion, "s.toml").back(), "s.toml");
  EXPECT_EQ(words, "convert\n" + source + "\n--dims\n40,30,20\n--type\nfloat32\n--encoding\nauto\n--rate\n2.5\n-o\n" +
                       conversion.output + "\n--scene\nscene.toml\n");
}

ConvertRequest of_rate(double rate) {
  ConvertRequest request;
  request.encoding = "packed";
  request.rate = rate;
  return request;
}

std::string refusal(const std::string& volume, const Sidecar& sidecar) {
  try {
    scene_conversion(volume, "", sidecar, of_rate(2));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(SceneConversionTest, NameThatIsTaken_IsNumbered) {
  const Sidecar said = sidecar();
  const auto output = [&] { return scene_conversion(volume_, "", said, of_rate(2)).output; };
  EXPECT_EQ(output(), directory_ / "v_scene.nvdb");
  write_file(directory_ / "v_scene.nvdb", "");
  EXPECT_EQ(output(), directory_ / "v_scene_2.nvdb");
  write_file(directory_ / "v_scene_2.nvdb.json", "{}");
  write_file(directory_ / "v_scene_4.nvdb", "");
  EXPECT_EQ(output(), directory_ / "v_scene_3.nvdb");
}

TEST_F(SceneConversionTest, OneOfSeveralVolumes_IsChosenAsTheSidecarHasIt) {
  Sidecar said = sidecar();
  said.weir.options = {{"dataset", "*"}, {"index", "time=*"}, {"component", "*"}};
  said.source.dataset = "/fields/v";
  said.source.index = {3, 1};
  said.source.component = "2";
  const std::string text = scene_conversion(volume_, "", said, of_rate(2)).text;
  EXPECT_NE(text.find(" --dataset /fields/v --index 3,1 --component 2 --encoding "), std::string::npos) << text;
  said.weir.options = {{"magnitude", "/u,/v"}};
  said.source.dataset = "/u,/v";
  said.source.component = "magnitude";
  const std::string lengths = scene_conversion(volume_, "", said, of_rate(2)).text;
  EXPECT_NE(lengths.find(".raw --index 3,1 --magnitude /u,/v --encoding "), std::string::npos) << lengths;
}

TEST_F(SceneConversionTest, LevelOfSeveral_IsRefused) {
  Sidecar said = sidecar();
  said.source.level = Sidecar::Level{1, 3};
  EXPECT_EQ(refusal(volume_, said),
            cat(volume_,
                ": is level 1 of 3, which no conversion makes alone; convert the source without --levels "
                "separate to have a volume of all levels, and view that"));
}

TEST_F(SceneConversionTest, SourceThatWasWrittenToSince_IsRefused) {
  const std::string source = directory_ / "v_40x30x20_float32.raw";
  const Sidecar said = sidecar();
  write_file(source, std::string(std::filesystem::file_size(source), '\1'));
  std::filesystem::last_write_time(source, std::filesystem::last_write_time(source) + std::chrono::hours(1));
  EXPECT_EQ(refusal(volume_, said), cat(source, ": is not the source of ", volume_, ", which had 96000 bytes as of ",
                                        said.source.mtime, "; put it there, or convert it again from where it is"));
}

TEST_F(SceneConversionTest, DirectoryNamedFromWhereTheProgramIs_IsTheSource) {
  Sidecar said = sidecar();
  said.source.path = std::filesystem::relative(directory_ / "plt00000").string();
  std::filesystem::create_directory(directory_ / "plt00000");
  EXPECT_EQ(scene_conversion(volume_, "", said, of_rate(2)).arguments.at(1), said.source.path);
  std::filesystem::create_directory(directory_ / "plt00001");
  said.source.path = "plt00001";
  EXPECT_EQ(scene_conversion(volume_, "", said, of_rate(2)).arguments.at(1), directory_ / "plt00001");
}

}  // namespace
}  // namespace weir::scene_conversion_test
