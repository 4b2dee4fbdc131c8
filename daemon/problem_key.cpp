#include "daemon/problem_key.h"

#include "format/text.h"

namespace weir {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::string_view without_path(std::string_view source, std::string_view reason) {
  if (!source.empty() && reason.starts_with(source) && reason.substr(source.size()).starts_with(": ")) {
    reason.remove_prefix(source.size() + 2);
  }
  return reason;
}

std::string problem_key(std::string_view source, std::string_view reason) {
  std::string text(without_path(source, reason));
  // The path or the name may stand further inside, too, as that of the output's.
  for (const std::string_view name : {source, source.substr(source.rfind('/') + 1)}) {
    if (name.empty()) continue;
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
      text.replace(at, name.size(), 1, '*');
    }
  }
  std::string key;
  for (const char c : text) {
    if (!is_digit(c)) {
      key += c;
    } else if (!key.ends_with('#')) {
      key += '#';
    }
  }
  return key;
}

}  // namespace weir
