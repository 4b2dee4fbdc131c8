#include "daemon/store/problem_key.h"

#include "format/base/ascii.h"
#include "format/base/text.h"

namespace weir {
namespace {

bool is_word_letter(char c) { return is_digit(c) || is_letter(c); }

// Returns whether the text at `at` is a whole word, not a part of a longer one.
bool is_word_at(std::string_view text, std::size_t at, std::size_t length) {
  const bool begins = at == 0 || !is_word_letter(text[at - 1]) || !is_word_letter(text[at]);
  const std::size_t end = at + length;
  return begins && (end == text.size() || !is_word_letter(text[end]) || !is_word_letter(text[end - 1]));
}

// Replaces the names of outputs. They begin with the name of the source up to its first dot: "/out/rho.nvdb",
// "/out/rho_density_3.nvdb.partial".
void hide_outputs(std::string& text, std::string_view source_name) {
  constexpr std::string_view kEnding = ".nvdb";
  const std::string begin = cat('/', source_name.substr(0, source_name.find('.')));
  if (begin.size() == 1) return;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    const std::size_t end = text.find(kEnding, at + begin.size());
    if (end == std::string::npos) return;
    if (!is_word_at(text, at, begin.size()) || text.find('/', at + 1) < end) continue;
    text.replace(at + 1, end - at - 1, 1, '*');
  }
}

}  // namespace

std::string_view without_path(std::string_view source, std::string_view reason) {
  if (!source.empty() && reason.starts_with(source) && reason.substr(source.size()).starts_with(": ")) {
    reason.remove_prefix(source.size() + 2);
  }
  return reason;
}

std::string problem_key(std::string_view source, std::string_view reason) {
  std::string text(without_path(source, reason));
  const std::string_view source_name = source.substr(source.rfind('/') + 1);
  // The path or the name may also stand further inside, for example within the name of an output.
  for (const std::string_view name : {source, source_name}) {
    if (name.empty()) continue;
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
      if (!is_word_at(text, at, name.size())) continue;
      text.replace(at, name.size(), 1, '*');
    }
  }
  hide_outputs(text, source_name);
  std::string key;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0x80) {
      key += '?';
    } else if (!is_digit(c)) {
      key += c;
    } else if (!key.ends_with('#')) {
      key += '#';
    }
  }
  return key.empty() ? "no reason" : key;
}

}  // namespace weir
