#include "ingest/headers/number_pattern.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
std::optional<NumberPattern> NumberPattern::parse(std::string_view text) {
  std::optional<NumberPattern> found;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') continue;
    std::size_t end = i + 1;
    while (end < text.size() && is_digit(text[end])) ++end;
    if (end >= text.size() || text[end] != 'd' || end - i > 4) continue;
    if (found) return std::nullopt;
    found.emplace();
    const std::string_view width = text.substr(i + 1, end - i - 1);
    found->pad_ = width.starts_with('0') ? '0' : ' ';
    found->width_ = static_cast<std::size_t>(parse_int(width).value_or(0));
    found->prefix_ = text.substr(0, i);
    found->suffix_ = text.substr(end + 1);
  }
  return found;
}

std::optional<std::int64_t> NumberPattern::match(std::string_view name) const {
  if (name.size() <= prefix_.size() + suffix_.size() || !name.starts_with(prefix_) || !name.ends_with(suffix_)) {
    return std::nullopt;
  }
  std::string_view digits = name.substr(prefix_.size(), name.size() - prefix_.size() - suffix_.size());
  digits.remove_prefix(std::min(digits.find_first_not_of(' '), digits.size()));
  if (!std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
  const auto number = parse_int(digits);
  if (!number || this->name(*number) != name) return std::nullopt;
  return number;
}

std::string NumberPattern::name(std::int64_t number) const {
  const std::string digits = std::to_string(number);
  return prefix_ + std::string(width_ - std::min(width_, digits.size()), pad_) + digits + suffix_;
}

std::string NumberPattern::stem() const {
  std::string before = prefix_;
  before.erase(before.find_last_not_of("_-. ") + 1);
  return before + std::filesystem::path("x" + suffix_).replace_extension().string().substr(1);
}

std::vector<NumberedFile> numbered_files(const std::string& pattern) {
  const std::filesystem::path path(pattern);
  const auto last = NumberPattern::parse(path.filename().string());
  if (!last) {
    throw Error(ErrorKind::usage,
                cat(pattern, ": no pattern: the file's name needs one %d or %05d where its number is"));
  }
  const std::filesystem::path directory = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  std::vector<NumberedFile> files;
  for (std::filesystem::directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    const auto number = last->match(entry->path().filename().string());
    if (number) files.push_back({*number, (path.parent_path() / entry->path().filename()).string()});
  }
  if (error) {
    throw Error(ErrorKind::input, cat(directory.string(), ": cannot list: ", error.message(), "; check the pattern"),
                SystemFailure{error.value(), directory.string()});
  }
  if (files.empty()) throw Error(ErrorKind::input, cat(pattern, ": no file's name matches; check the pattern"));
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  return files;
}

std::string padded_number(std::int64_t number, std::int64_t largest) {
  const std::size_t width = std::to_string(largest).size();
  std::string digits = std::to_string(number);
  return std::string(width - std::min(width, digits.size()), '0') + digits;
}

std::string joined_name(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + '_' + b;
}

}  // namespace weir
