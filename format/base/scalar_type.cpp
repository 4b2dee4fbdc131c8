#include "format/base/scalar_type.h"

#include <array>

namespace weir {
namespace {

struct Entry {
  ScalarType type;
  std::string_view name;
  std::size_t bytes;
};

constexpr std::array<Entry, 12> kTypes{{{ScalarType::uint8, "uint8", 1},
                                        {ScalarType::int8, "int8", 1},
                                        {ScalarType::uint16, "uint16", 2},
                                        {ScalarType::int16, "int16", 2},
                                        {ScalarType::uint32, "uint32", 4},
                                        {ScalarType::int32, "int32", 4},
                                        {ScalarType::uint64, "uint64", 8},
                                        {ScalarType::int64, "int64", 8},
                                        {ScalarType::float16, "float16", 2},
                                        {ScalarType::bfloat16, "bfloat16", 2},
                                        {ScalarType::float32, "float32", 4},
                                        {ScalarType::float64, "float64", 8}}};

struct Alias {
  std::string_view name;
  ScalarType type;
};

// The names of C and numpy.
constexpr std::array<Alias, 13> kAliases{{{"float", ScalarType::float32},
                                          {"double", ScalarType::float64},
                                          {"u1", ScalarType::uint8},
                                          {"i1", ScalarType::int8},
                                          {"u2", ScalarType::uint16},
                                          {"i2", ScalarType::int16},
                                          {"u4", ScalarType::uint32},
                                          {"i4", ScalarType::int32},
                                          {"u8", ScalarType::uint64},
                                          {"i8", ScalarType::int64},
                                          {"f2", ScalarType::float16},
                                          {"f4", ScalarType::float32},
                                          {"f8", ScalarType::float64}}};

template <typename Entries>
std::string names_of(const Entries& entries) {
  std::string all;
  for (const auto& entry : entries) {
    if (!all.empty()) all += ", ";
    all += entry.name;
  }
  return all;
}

}  // namespace

std::size_t scalar_bytes(ScalarType type) { return kTypes[static_cast<std::size_t>(type)].bytes; }

std::string_view scalar_name(ScalarType type) { return kTypes[static_cast<std::size_t>(type)].name; }

std::optional<ScalarType> parse_scalar(std::string_view name) {
  for (const Entry& entry : kTypes) {
    if (entry.name == name) return entry.type;
  }
  for (const Alias& alias : kAliases) {
    if (alias.name == name) return alias.type;
  }
  return std::nullopt;
}

OrderedName split_byte_order(std::string_view name) {
  if (name.empty() || std::string_view("<>|=").find(name.front()) == std::string_view::npos) return {name, {}};
  const char mark = name.front();
  name.remove_prefix(1);
  if (mark != '<' && mark != '>') return {name, {}};
  return {name, mark == '>'};
}

std::string scalar_names() { return names_of(kTypes); }

std::string scalar_aliases() { return names_of(kAliases); }

}  // namespace weir
