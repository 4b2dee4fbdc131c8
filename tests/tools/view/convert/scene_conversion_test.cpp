#include "tools/view/convert/scene_conversion.h"

#include <filesystem>

#include "format/base/error.h"
#include "tests/tools/support/converted_volume.h"

namespace weir::scene_conversion_test {
namespace {

class SceneConversionTest : public ConvertedVolume {};

TEST_F(SceneConversionTest, CommandThatIsShown_IsFitForAShell) {
  const std::string volume = directory_ / "it's a $(file).nvdb";
  const std::string source = directory_ / "it's a `source`.raw";
  std::filesystem::copy(volume_, volume);
  std::filesystem::copy(directory_ / "v_40x30x20_float32.raw", source);
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
  // A shell takes the text apart into the very words.
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

}  // namespace
}  // namespace weir::scene_conversion_test
