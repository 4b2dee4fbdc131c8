#include "bindings/c/short_text.h"

#include <algorithm>

namespace weir::c {
namespace {

constexpr std::string_view kGap = "...";

bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

}  // namespace

void copy_shortened(std::string_view text, std::span<char> out) noexcept {
  const std::size_t most = out.size() - 1;
  if (text.size() <= most) {
    *std::ranges::copy(text, out.begin()).out = '\0';
    return;
  }
  std::size_t head = (most - kGap.size()) / 2;
  std::size_t tail = text.size() - (most - kGap.size() - head);
  while (head > 0 && continues_character(text[head])) --head;
  while (tail < text.size() && continues_character(text[tail])) ++tail;
  auto at = std::ranges::copy(text.substr(0, head), out.begin()).out;
  at = std::ranges::copy(kGap, at).out;
  *std::ranges::copy(text.substr(tail), at).out = '\0';
}

}  // namespace weir::c
