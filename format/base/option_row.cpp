#include "format/base/option_row.h"

#include <algorithm>

namespace weir {
namespace {

/// Returns "a", "a or b" or "a, b or c".
Message list_of(const std::vector<Message>& items, std::string_view last) {
  Message list;
  for (std::size_t i = 0; i < items.size(); ++i) {
    list += compose(i == 0 ? "" : i + 1 == items.size() ? last : ", ", items[i]);
  }
  return list;
}

}  // namespace

std::string OptionRow::meaning() const { return cat(help, of_several); }

std::string OptionRow::text() const { return standard.empty() ? meaning() : cat(meaning(), "; default: ", standard); }

OptionRow OptionRow::of_one_volume() const {
  OptionRow row = *this;
  row.of_several = {};
  row.several = false;
  return row;
}

Error wrong_option(std::string_view key, std::string_view text, const Message& form) {
  return usage_error(compose(option(key), " is \"", text, "\", it must be ", form));
}

bool read_flag(const OptionRow& row, const std::string& text) {
  if (text != "true" && text != "false") throw wrong_option(row.key, text, "true or false");
  return text == "true";
}

std::size_t read_choice(const OptionRow& row, const std::string& text) {
  const std::vector<std::string> choices = split(row.argument, '|');
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end()) {
    throw wrong_option(row.key, text, list_of({choices.begin(), choices.end()}, " or "));
  }
  return static_cast<std::size_t>(found - choices.begin());
}

GivenOptions without_empty(GivenOptions given) {
  std::erase_if(given, [](const auto& option) { return option.second.empty(); });
  return given;
}

void check_exclusions(const std::vector<OptionRow>& table, const GivenOptions& given) {
  for (const OptionRow& row : table) {
    if (!given.contains(row.key)) continue;
    std::vector<Message> group;
    std::size_t given_of_group = 0;
    for (const OptionRow& other : table) {
      if (row.group.empty() || other.group != row.group) continue;
      group.push_back(option(other.key));
      given_of_group += given.contains(other.key) ? 1 : 0;
    }
    if (given_of_group > 1) {
      throw usage_error(compose(list_of(group, " and "), " exclude each other; give one"));
    }
    for (const std::string& other : split(row.excludes, ',')) {
      if (!given.contains(other)) continue;
      throw usage_error(compose(option(row.key), " and ", option(other), " exclude each other; give one"));
    }
  }
}

}  // namespace weir
