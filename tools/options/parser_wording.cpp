#include "tools/options/parser_wording.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/text.h"

namespace weir {
namespace {

// Returns "a", "a or b", "a, b or c" for "a", "a,b", "a,b,c".
std::string alternatives(const std::string& list) {
  const std::vector<std::string> words = split(list, ',');
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += cat(i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words[i]);
  }
  return text;
}

// The text before and behind a word. A regular expression would recurse as deep as the text is long, so plain searches
// are used.
struct Around {
  std::string before;
  std::string behind;
};

std::optional<Around> around(const std::string& text, std::size_t at, std::string_view word) {
  if (at == std::string::npos) return std::nullopt;
  return Around{text.substr(0, at), text.substr(at + word.size())};
}
std::optional<Around> around_first(const std::string& text, std::string_view word) {
  return around(text, text.find(word), word);
}
std::optional<Around> around_last(const std::string& text, std::string_view word) {
  return around(text, text.rfind(word), word);
}

// Returns the text between `begin` and `end` if `text` begins and ends with them.
std::optional<std::string> between(const std::string& text, std::string_view begin, std::string_view end) {
  if (text.size() < begin.size() + end.size() || !text.starts_with(begin) || !text.ends_with(end)) return std::nullopt;
  return text.substr(begin.size(), text.size() - begin.size() - end.size());
}

bool is_one_word(const std::string& text) {
  return !text.empty() && text.find_first_of(" \t\n\r\f\v") == std::string::npos;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

using ValuesOf = std::function<std::string(const std::string& option)>;

// Rewords a fault such as "At Most 1 required but received 2".
std::optional<std::string> count_wording(const std::string& option, const std::string& fault,
                                         const ValuesOf& values_of) {
  const auto numbers = around_first(fault, " required but received ");
  if (!numbers || !is_number(numbers->behind)) return std::nullopt;
  const std::string& received = numbers->behind;
  const bool most = numbers->before.starts_with("At Most ");
  if (!most && !numbers->before.starts_with("At least ")) return std::nullopt;
  const std::string taken = numbers->before.substr(numbers->before.rfind(' ') + 1);
  if (!is_number(taken)) return std::nullopt;
  if (most && taken == "1") return cat(option, " is given ", received, " times; give it once");
  const std::string values = values_of ? values_of(option) : "";
  return cat(option, " has ", received, received == "1" ? " value" : " values", ", it takes ", taken,
             values.empty() ? "" : ": ", values);
}

// Rewords `fault`, the text that CLI11 prints behind "OPTION: ".
std::optional<std::string> value_wording(const std::string& option, const std::string& fault) {
  if (const auto value = between(fault, "1 required ", " missing")) return cat(option, " needs a value, ", *value);
  if (const auto path = between(fault, "Directory does not exist: ", "")) {
    return cat(option, " is \"", *path, "\", which does not exist; name a directory");
  }
  if (const auto path = between(fault, "Directory is actually a file: ", "")) {
    return cat(option, " is \"", *path, "\", which is a file; name a directory");
  }
  if (const auto parts = around_last(fault, " not in range "); parts && parts->before.starts_with("Value ")) {
    const std::string value = parts->before.substr(std::string_view("Value ").size());
    if (const auto ends = around_first(parts->behind, " to ")) {
      constexpr std::size_t kLongNumber = 100;  // digits: a range without an upper end prints the largest double
      const bool endless = ends->behind.size() > kLongNumber;
      return cat(option, " is \"", value, "\", it must be a number from ", endless ? "0 on" : parts->behind);
    }
  }
  if (const auto parts = around_last(fault, " not in {"); parts && parts->behind.ends_with('}')) {
    return cat(option, " is \"", parts->before, "\", it must be ",
               alternatives(parts->behind.substr(0, parts->behind.size() - 1)));
  }
  return std::nullopt;
}

}  // namespace

std::string parser_wording(const std::string& text, const ValuesOf& values_of) {
  if (const auto failed = between(text, "Could not convert: ", "")) {
    const auto parts = around_first(*failed, " = ");
    if (parts && is_one_word(parts->before)) {
      return cat(parts->before, " is \"", parts->behind, "\", it must be a number");
    }
  }
  if (const auto parts = around_first(text, ": "); parts && is_one_word(parts->before)) {
    if (const auto counted = count_wording(parts->before, parts->behind, values_of)) return *counted;
    if (const auto named = value_wording(parts->before, parts->behind)) return *named;
  }
  const auto needs = around_first(text, " requires ");
  if (needs && is_one_word(needs->before) && is_one_word(needs->behind)) {
    return cat(needs->before, " needs ", needs->behind);
  }
  return text;
}

}  // namespace weir
