#include "format/base/scalar_type.h"

#include <array>

namespace weir {
namespace {

struct Entry {
  ScalarType type;
  std::string_view name;
  std::size_t bytes;
};

constexpr std::array<Entry, 11> kTypes{{{ScalarType::uint8, "uint8", 1},
                                        {ScalarType::int8, "int8", 1},
                                        {ScalarType::uint16, "uint16", 2},
                                        {ScalarType::int16, "int16", 2},
                                        {ScalarType::uint32, "uint32", 4},
                                        {ScalarType::int32, "int32", 4},
                                        {ScalarType::uint64, "uint64", 8},
                                        {ScalarType::int64, "int64", 8},
                                        {ScalarType::float16, "float16", 2},
                                        {ScalarType::float32, "float32", 4},
                                        {ScalarType::float64, "float64", 8}}};

}  // namespace

std::size_t scalar_bytes(ScalarType type) { return kTypes[static_cast<std::size_t>(type)].bytes; }

std::string_view scalar_name(ScalarType type) { return kTypes[static_cast<std::size_t>(type)].name; }

std::optional<ScalarType> parse_scalar(std::string_view name) {
  for (const Entry& entry : kTypes) {
    if (entry.name == name) return entry.type;
  }
  return std::nullopt;
}

std::string scalar_names() {
  std::string all;
  for (const Entry& entry : kTypes) {
    if (!all.empty()) all += ", ";
    all += entry.name;
  }
  return all;
}

}  // namespace weir
