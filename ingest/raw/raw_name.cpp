#include "ingest/raw/raw_name.h"

#include <algorithm>
#include <array>
#include <limits>

#include "format/base/ascii.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::string_view kExtension = ".raw";
constexpr std::string_view kBigEndian = "be";

std::optional<std::int64_t> parse_axis(std::string_view text) {
  const bool negative = text.starts_with('-');
  const std::string_view digits = text.substr(negative ? 1 : 0);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
  if (const auto value = parse_int(text)) return value;
  return negative ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
}

std::optional<Index3> parse_extent(std::string_view text) {
  const auto parts = split(text, 'x');
  if (parts.size() != 3) return std::nullopt;
  const std::array axes{parse_axis(parts[0]), parse_axis(parts[1]), parse_axis(parts[2])};
  if (!axes[0] || !axes[1] || !axes[2]) return std::nullopt;
  return Index3{*axes[0], *axes[1], *axes[2]};
}

}  // namespace

std::optional<RawName> parse_raw_name(std::string_view path) {
  std::string_view file = path.substr(path.find_last_of('/') + 1);
  if (!lower_case(file).ends_with(kExtension)) return std::nullopt;
  file.remove_suffix(kExtension.size());

  const std::size_t before_type = file.rfind('_');
  if (before_type == std::string_view::npos || before_type == 0) return std::nullopt;
  const std::size_t before_extent = file.rfind('_', before_type - 1);
  if (before_extent == std::string_view::npos || before_extent == 0) return std::nullopt;
  const auto extent = parse_extent(file.substr(before_extent + 1, before_type - before_extent - 1));
  if (!extent) return std::nullopt;

  RawName result;
  result.name = file.substr(0, before_extent);
  result.extent = *extent;
  result.type_text = file.substr(before_type + 1);
  auto [type, big_endian] = split_byte_order(result.type_text);
  if (type.ends_with(kBigEndian)) {
    big_endian = true;
    type.remove_suffix(kBigEndian.size());
  }
  result.type = parse_scalar(type);
  result.big_endian = big_endian.value_or(false);
  return result;
}

}  // namespace weir
