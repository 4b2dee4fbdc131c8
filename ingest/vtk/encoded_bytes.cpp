#include "ingest/vtk/encoded_bytes.h"

#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::uint8_t kNoDigit = 64;

/// RFC 4648, table 1.
constexpr std::array<std::uint8_t, 256> kDigits = [] {
  std::array<std::uint8_t, 256> digits{};
  digits.fill(kNoDigit);
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return digits;
}();

}  // namespace

void EncodedBytes::read(std::span<std::byte> into) {
  for (std::byte& byte : into) {
    if (base64_) {
      if (group_left_ == 0 && !decode_group()) {
        throw Error(ErrorKind::input, cat(where_, ": its base64 text ends too early; the file is cut or damaged"));
      }
      byte = group_[group_size_ - group_left_--];
    } else {
      const int next = text_.next();
      if (next < 0) throw Error(ErrorKind::input, cat(where_, ": its data end too early; the file is cut or damaged"));
      byte = static_cast<std::byte>(next);
    }
  }
}

// Four digits are three bytes; one or two '=' at the end stand for absent bytes.
bool EncodedBytes::decode_group() {
  std::uint32_t bits = 0;
  unsigned digits = 0;
  unsigned padding = 0;
  while (digits + padding < 4) {
    const int c = text_.next();
    if (c < 0) return false;
    if (is_space(c)) continue;
    if (c == '=' && digits >= 2) {
      ++padding;
      bits <<= 6U;
      continue;
    }
    const std::uint8_t digit = kDigits[static_cast<std::size_t>(c)];
    if (digit == kNoDigit || padding > 0) {
      const char found = static_cast<char>(c);
      throw Error(ErrorKind::input, cat(where_, ": its base64 text has the character ", in_quotes({&found, 1}),
                                        "; it ends too early or is damaged"));
    }
    bits = bits << 6U | digit;
    ++digits;
  }
  group_ = {static_cast<std::byte>(bits >> 16U), static_cast<std::byte>(bits >> 8U), static_cast<std::byte>(bits)};
  group_size_ = 3 - padding;
  group_left_ = group_size_;
  return true;
}

}  // namespace weir
