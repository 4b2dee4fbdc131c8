#include "ingest/vtk/vtk_legacy_text.h"

#include <array>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {

int VtkLegacyText::next() {
  if (position_ == size_) return -1;
  const auto c = bytes_.sbumpc();
  if (c == std::char_traits<char>::eof()) fail("the file ends early; was it cut?");
  ++position_;
  return c;
}

std::optional<std::string_view> VtkLegacyText::line() {
  line_.clear();
  int c = next();
  if (c < 0) return std::nullopt;
  for (; c >= 0 && c != '\n'; c = next()) {
    if (line_.size() == kMaxLineBytes) fail(cat("a line is longer than ", kMaxLineBytes, " bytes"));
    line_ += static_cast<char>(c);
  }
  if (line_.ends_with('\r')) line_.pop_back();
  return line_;
}

std::string VtkLegacyText::first_word() const {
  const auto all = words(line_);
  return all.empty() ? std::string() : std::string(all.front());
}

void VtkLegacyText::skip_paragraph() {
  for (auto text = line(); text && !trimmed(*text).empty(); text = line()) continue;
}

void VtkLegacyText::require_bytes(std::uint64_t count) const {
  if (count > size_ - position_) {
    fail(cat(count, " bytes of values belong behind it, and the file ends after ", size_ - position_,
             "; is it complete?"));
  }
}

void VtkLegacyText::skip_bytes(std::uint64_t count) {
  require_bytes(count);
  position_ += count;
  bytes_.pubseekpos(static_cast<std::streamoff>(position_));
}

void VtkLegacyText::skip_words(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    int c = next();
    while (is_space(c)) c = next();
    if (c < 0) lacks_values(count, i);
    while (c >= 0 && !is_space(c)) c = next();
  }
}

void VtkLegacyText::skip_lines(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    int c = next();
    if (c < 0) lacks_values(count, i);
    while (c >= 0 && c != '\n') c = next();
  }
}

void VtkLegacyText::skip_strings(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t length = string_length(i, count);
    if (length > kMaxLineBytes) {
      skip_bytes(length);
      continue;
    }
    require_bytes(length);
    for (std::uint64_t at = 0; at < length; ++at) next();
  }
}

std::uint64_t VtkLegacyText::string_length(std::uint64_t index, std::uint64_t count) {
  const int first = next();
  if (first < 0) lacks_values(count, index);
  constexpr std::array<std::uint64_t, 4> kMoreBytes{7, 3, 1, 0};
  const auto bits = static_cast<unsigned>(first);
  const std::uint64_t more = kMoreBytes[bits >> 6U];
  require_bytes(more);
  std::uint64_t length = bits & 0x3FU;
  for (std::uint64_t i = 0; i < more; ++i) length = length << 8U | static_cast<std::uint64_t>(next());
  return length;
}

void VtkLegacyText::lacks_values(std::uint64_t count, std::uint64_t found) const {
  fail(cat(count, " values belong before it, and there are ", found, "; is the file complete?"));
}

void VtkLegacyText::read_bytes(std::span<std::byte> into) {
  require_bytes(into.size());
  for (std::byte& byte : into) byte = static_cast<std::byte>(next());
}

std::string VtkLegacyText::word() {
  int c = next();
  while (is_space(c)) c = next();
  if (c < 0) fail("a value belongs before it, and there is none; is the file complete?");
  std::string text;
  for (; c >= 0 && !is_space(c); c = next()) {
    if (text.size() < kMaxLineBytes) text += static_cast<char>(c);
  }
  return text;
}

void VtkLegacyText::fail(std::string_view what) const {
  throw Error(ErrorKind::input, cat(path_, ": before byte ", position_, ": ", what));
}

}  // namespace weir
