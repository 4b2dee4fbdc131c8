#include "daemon/log/plain_text.h"

#include <algorithm>

#include "format/base/utf8.h"

namespace weir {
namespace {

bool is_between(std::string_view character, std::string_view first, std::string_view last) {
  return character.size() == first.size() && character >= first && character <= last;  // as bytes without a sign
}

}  // namespace

std::size_t plain_bytes(std::string_view text) {
  const std::string_view character = text.substr(0, utf8_bytes(text));
  const bool steers = is_between(character, std::string_view("\0", 1), "\x1f") || character == "\x7f" ||
                      is_between(character, "\xc2\x80", "\xc2\x9f") ||
                      is_between(character, "\xe2\x80\xa8", "\xe2\x80\xae") ||  // U+2028 to U+202E
                      is_between(character, "\xe2\x81\xa6", "\xe2\x81\xa9");    // U+2066 to U+2069
  return steers ? 0 : character.size();
}

std::string masked_text(std::string_view text) {
  std::string masked;
  while (!text.empty()) {
    const std::size_t plain = plain_bytes(text);
    masked += plain == 0 ? "?" : text.substr(0, plain);
    text.remove_prefix(std::max<std::size_t>(plain, 1));
  }
  return masked;
}

}  // namespace weir
