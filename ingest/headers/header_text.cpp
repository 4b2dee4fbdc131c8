#include "ingest/headers/header_text.h"

#include <algorithm>
#include <filesystem>
#include <span>

#include "format/base/text.h"

namespace weir {
namespace {

template <typename T>
std::optional<std::vector<T>> parse_all(std::string_view text, std::optional<T> (*parse)(std::string_view)) {
  std::vector<T> values;
  for (std::string_view word : words(text)) {
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto value = parse(word);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

}  // namespace

std::string read_head(InputFile& file, std::size_t limit) {
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), limit)), '\0');
  file.read_buffered(0, std::as_writable_bytes(std::span(head)), ReadPath::through);
  return head;
}

std::optional<std::string_view> LineReader::next() {
  if (position_ == text_.size()) return std::nullopt;
  const std::size_t end = text_.find('\n', position_);
  open_ended_ = end == std::string_view::npos;
  std::string_view line = text_.substr(position_, open_ended_ ? end : end - position_);
  position_ = open_ended_ ? text_.size() : end + 1;
  ++number_;
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> found;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const auto stop = std::find_if(text.begin(), text.end(), [](char c) { return is_space(c); });
    const auto length = static_cast<std::size_t>(stop - text.begin());
    found.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return found;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown) c = c >= ' ' && c <= '~' ? c : '?';
  return cat('\'', shown, text.size() > kLongest ? "...'" : "'");
}

std::optional<std::vector<std::int64_t>> parse_ints(std::string_view text) { return parse_all(text, parse_int); }

std::optional<std::vector<double>> parse_doubles(std::string_view text) { return parse_all(text, parse_double); }

std::string path_beside(const std::string& header_path, std::string_view name) {
  return (std::filesystem::path(header_path).parent_path() / std::filesystem::path(name)).string();
}

}  // namespace weir
