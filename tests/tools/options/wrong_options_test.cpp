// Tests the wrong options of the list wrong_options.json. Every front end refuses them for the same reason, with its
// own names of the options. tests/bindings/python/test_options.py reads the same list.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "bindings/c/weir.h"
#include "bindings/c/wording.h"
#include "compressor/options/conversion_request.h"
#include "daemon/config/watch_options.h"
#include "tests/support/message_of_error.h"
#include "tests/support/run_command.h"

namespace weir::wrong_options_test {
namespace {

struct WrongOptions {
  GivenOptions given;
  Message reason;
};

/// Parses a reason like "{metric farthest} has no ...": braces enclose an option and its value.
Message parse_reason(const std::string& text) {
  Message message;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = std::min(text.find('{', at), text.size());
    message += compose(text.substr(at, open - at));
    if (open == text.size()) break;
    const std::size_t close = text.find('}', open);
    const std::string name = text.substr(open + 1, close - open - 1);
    const std::size_t space = std::min(name.find(' '), name.size());
    message += OptionName{name.substr(0, space), space < name.size() ? name.substr(space + 1) : ""};
    at = close + 1;
  }
  return message;
}

std::vector<WrongOptions> wrong_options() {
  std::vector<WrongOptions> all;
  const std::string path = std::string(WEIR_SOURCE_DIR) + "/tests/tools/options/wrong_options.json";
  for (const auto& entry : nlohmann::json::parse(read_file(path))) {
    all.push_back({entry["given"].get<GivenOptions>(), parse_reason(entry["reason"])});
  }
  return all;
}

bool has_wrong_flag(const GivenOptions& given) {
  return std::any_of(given.begin(), given.end(), [](const auto& o) { return conversion_option(o.first).flag(); });
}

TEST(WrongOptions, ListHasEveryOptionThatCanBeWrong) {
  const std::set<std::string_view> any_text{"dataset", "scene", "work-dir"};
  std::set<std::string_view> wanted;
  for (const auto table : {input_options(), method_options(), run_options()}) {
    for (const ConversionOption& option : table) {
      if (!any_text.contains(option.row.key)) wanted.insert(option.row.key);
    }
  }
  const std::vector<WrongOptions> all = wrong_options();
  for (const std::string_view key : wanted) {
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const WrongOptions& w) { return w.given.contains(key); }))
        << key;
  }
}

TEST(WrongOptions, CommandLine) {
  const std::string input = std::string(WEIR_SOURCE_DIR) + "/none_8x8x8_uint8.raw";
  for (const WrongOptions& wrong : wrong_options()) {
    if (has_wrong_flag(wrong.given)) continue;  // the parser refuses any value of a flag
    std::vector<std::string> arguments{"convert", input};
    for (const auto& [key, text] : wrong.given) arguments.push_back("--" + key + "=" + text);
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "weir: " + wrong.reason.text() + "\n");
  }
}

TEST(WrongOptions, Configuration) {
  const std::vector<OptionRow> rows = watch_options();
  int refused = 0;
  for (const WrongOptions& wrong : wrong_options()) {
    std::string text;
    for (const auto& [key, value] : wrong.given) text += key_wording({key, {}}) + " = '" + value + "'\n";
    const toml::table table = parse_toml(text, "/c.toml");
    TomlReader reader(table, "[[watch]]", "/c.toml");
    const auto known = [&](const auto& option) {
      const auto is_it = [&](const OptionRow& row) { return row.key == option.first && !row.flag(); };
      return std::ranges::any_of(rows, is_it);
    };
    if (!std::all_of(wrong.given.begin(), wrong.given.end(), known)) continue;
    ++refused;
    const std::string message = message_of_error(ErrorKind::input, [&] { read_watch_options(reader, table); });
    EXPECT_EQ(message.substr(message.find(": ") + 2), wrong.reason.worded(key_wording));
  }
  EXPECT_EQ(refused, 52);
}

/// Sets the members of `o` that mean the same as `given`. Returns false if C cannot express the options.
bool set_members(const GivenOptions& given, weir_convert_options& o) {
  for (const auto& [key, text] : given) {
    const double number = std::strtod(text.c_str(), nullptr);
    if (key == "rate" || key == "psnr" || key == "max-error") {
      if (o.budget_kind != WEIR_BUDGET_AUTO) return false;
      o.budget_kind = key == "rate" ? WEIR_BUDGET_RATE : key == "psnr" ? WEIR_BUDGET_PSNR : WEIR_BUDGET_MAX_ERROR;
      o.budget = number;
    } else if (key == "at-most") {
      o.at_most = 1;
    } else if (key == "size") {
      o.budget_kind = WEIR_BUDGET_SIZE;
    } else if (key == "metric" && text == "farthest") {
      o.metric = WEIR_METRIC_FARTHEST;
    } else if (key == "encoding" && (text == "fpn" || text == "packed")) {
      o.encoding = text == "fpn" ? WEIR_ENCODING_FPN : WEIR_ENCODING_PACKED;
    } else if (key == "preview" && (text == "on" || text == "off")) {
      o.preview = text == "on" ? WEIR_PREVIEW_ON : WEIR_PREVIEW_OFF;
    } else if (key == "fill" && text == "background") {
      o.fill = WEIR_FILL_BACKGROUND;
    } else if (key == "backend" && text == "cuda") {
      o.backend = WEIR_BACKEND_CUDA;
    } else if (key == "background") {
      o.has_background = 1;
      o.background = static_cast<float>(number);
    } else if (key == "brick") {
      o.brick = std::atoi(text.c_str());
    } else if (key == "threads") {
      o.threads = std::atoi(text.c_str());
    } else {
      return false;
    }
  }
  return true;
}

TEST(WrongOptions, CMembers) {
  int refused = 0;
  for (const WrongOptions& wrong : wrong_options()) {
    weir_convert_options options;
    weir_convert_options_init(&options, sizeof options);
    if (!set_members(wrong.given, options)) continue;
    ++refused;
    weir_volume volume;
    weir_volume_init(&volume, sizeof volume);
    volume.type = WEIR_UINT8;
    std::fill(std::begin(volume.extent), std::end(volume.extent), 8);
    const std::vector<std::uint8_t> values(512);
    weir_error error{};
    EXPECT_EQ(weir_convert(&volume, values.data(), nullptr, &options, "/none/a.nvdb", &error), WEIR_ERROR_USAGE);
    EXPECT_EQ(std::string(error.message), wrong.reason.worded(c::c_wording));
  }
  EXPECT_EQ(refused, 18);
}

}  // namespace
}  // namespace weir::wrong_options_test
