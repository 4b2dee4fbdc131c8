#include "tools/options/parser_wording.h"

#include <cstddef>
#include <optional>
#include <regex>
#include <vector>

#include "format/base/text.h"

namespace weir {
namespace {

// "a", "a or b", "a, b or c" of "a,b,c".
std::string alternatives(const std::string& list) {
  const std::vector<std::string> words = split(list, ',');
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += cat(i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words[i]);
  }
  return text;
}

std::optional<std::smatch> match(const std::string& text, const char* pattern) {
  std::smatch found;
  if (!std::regex_match(text, found, std::regex(pattern))) return std::nullopt;
  return found;
}

}  // namespace

std::string parser_wording(const std::string& text,
                           const std::function<std::string(const std::string& option)>& values_of) {
  if (const auto m = match(text, "(\\S+): 1 required (.*) missing")) {
    return cat(m->str(1), " needs a value, ", m->str(2));
  }
  if (const auto m = match(text, "(\\S+): At Most 1 required but received ([0-9]+)")) {
    return cat(m->str(1), " is given ", m->str(2), " times; give it once");
  }
  if (const auto m = match(text, "(\\S+): At (?:least|Most) ([0-9]+) required but received ([0-9]+)")) {
    const std::string values = values_of ? values_of(m->str(1)) : "";
    return cat(m->str(1), " has ", m->str(3), m->str(3) == "1" ? " value" : " values", ", it takes ", m->str(2),
               values.empty() ? "" : ": ", values);
  }
  if (const auto m = match(text, "Could not convert: (\\S+) = ([^]*)")) {
    return cat(m->str(1), " is \"", m->str(2), "\", it must be a number");
  }
  if (const auto m = match(text, "(\\S+): ([^]*) not in \\{(.*)\\}")) {
    return cat(m->str(1), " is \"", m->str(2), "\", it must be ", alternatives(m->str(3)));
  }
  if (const auto m = match(text, "(\\S+): Value ([^]*) not in range (.*) to (.*)")) {
    constexpr std::size_t kLongNumber = 100;  // digits: the largest double, where there is no end
    const bool endless = m->str(4).size() > kLongNumber;
    return cat(m->str(1), " is \"", m->str(2), "\", it must be a number from ",
               endless ? "0 on" : cat(m->str(3), " to ", m->str(4)));
  }
  if (const auto m = match(text, "(\\S+): Directory does not exist: ([^]*)")) {
    return cat(m->str(1), " is \"", m->str(2), "\", which does not exist; name a directory");
  }
  if (const auto m = match(text, "(\\S+) requires (\\S+)")) return cat(m->str(1), " needs ", m->str(2));
  return text;
}

}  // namespace weir
