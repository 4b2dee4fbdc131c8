#include "format/nanovdb/macrocells.h"

#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::string_view kPrefix = "weir_macrocells";

}  // namespace

std::string macrocell_name(const MacrocellName& shape) { return cat(kPrefix, ':', shape.cell, ':', shape.apron); }

std::optional<MacrocellName> parse_macrocell_name(std::string_view text) {
  const auto parts = split(text, ':');
  if (parts.size() != 3 || parts[0] != kPrefix) return std::nullopt;
  const auto cell = parse_int(parts[1]);
  const auto apron = parse_int(parts[2]);
  if (!cell || *cell < 8 || *cell > 4096 || *cell % 8 != 0) return std::nullopt;
  if (!apron || *apron < 0 || *apron > 8) return std::nullopt;
  return MacrocellName{*cell, *apron};
}

}  // namespace weir
