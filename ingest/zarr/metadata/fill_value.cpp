#include "ingest/zarr/metadata/fill_value.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/stored_value.h"
#include "ingest/values/half_values.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

template <typename T>
std::vector<std::byte> bytes_of(T value) {
  std::vector<std::byte> bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

template <typename T>
std::vector<std::byte> bytes_as(const StoredValue& value) {
  return std::visit([](auto v) { return bytes_of(static_cast<T>(v)); }, value);
}

/// Returns `value` as bytes of `type` in this machine's order. `type` must be able to hold `value`.
std::vector<std::byte> native_bytes(ScalarType type, const StoredValue& value) {
  switch (type) {
    case ScalarType::uint8:
      return bytes_as<std::uint8_t>(value);
    case ScalarType::int8:
      return bytes_as<std::int8_t>(value);
    case ScalarType::uint16:
      return bytes_as<std::uint16_t>(value);
    case ScalarType::int16:
      return bytes_as<std::int16_t>(value);
    case ScalarType::uint32:
      return bytes_as<std::uint32_t>(value);
    case ScalarType::int32:
      return bytes_as<std::int32_t>(value);
    case ScalarType::uint64:
      return bytes_as<std::uint64_t>(value);
    case ScalarType::int64:
      return bytes_as<std::int64_t>(value);
    case ScalarType::float16:
      return bytes_of(half_bits(as_double(value)));
    case ScalarType::bfloat16:
      return bytes_of(bfloat16_bits(as_double(value)));
    case ScalarType::float32:
      return bytes_as<float>(value);
    case ScalarType::float64:
      return bytes_as<double>(value);
  }
  return {};
}

/// Parses text like "0x7fc00000", the bits of a value of `size` bytes, and returns the bytes, the highest first.
std::optional<std::vector<std::byte>> hexadecimal(std::string_view text, std::size_t size) {
  if (!text.starts_with("0x") || text.size() != 2 + 2 * size) return std::nullopt;
  text.remove_prefix(2);
  std::uint64_t bits = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), bits, 16);
  if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[size - 1 - i] = static_cast<std::byte>(bits >> (8 * i));
  return bytes;
}

/// Returns the `size` bytes that `text` encodes (RFC 4648, section 4); nullopt if it does not encode `size` bytes.
std::optional<std::vector<std::byte>> base64(std::string_view text, std::size_t size) {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() != (size * 8 + 5) / 6) return std::nullopt;
  std::vector<std::byte> bytes;
  std::uint32_t bits = 0;
  unsigned held = 0;
  for (const char c : text) {
    const std::size_t digit = kAlphabet.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> held));
  }
  return bytes;
}

}  // namespace

std::vector<std::byte> fill_bytes(const nlohmann::json& fill, ScalarType type, bool big_endian,
                                  const std::string& where) {
  const std::size_t size = scalar_bytes(type);
  const auto number = number_in_fill(fill);
  if (number && holds(type, *number)) {
    // holds() is false for an integer type and a NaN or an infinity.
    std::vector<std::byte> bytes = native_bytes(type, *number);
    if (big_endian != kNativeIsBig) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  }
  if (!number && fill.is_string()) {
    const std::string text = fill.get<std::string>();
    if (auto bits = hexadecimal(text, size)) {
      if (!big_endian) std::reverse(bits->begin(), bits->end());
      return *bits;
    }
    if (auto stored = base64(text, size)) return *stored;
  }
  throw input_error(
      where, cat("fill_value is ", json_text(fill), ", which is no ", scalar_name(type), "; the file is damaged"));
}

std::optional<StoredValue> number_in_fill(const nlohmann::json& fill) {
  if (fill == "Infinity") return StoredValue{std::numeric_limits<double>::infinity()};
  if (fill == "-Infinity") return StoredValue{-std::numeric_limits<double>::infinity()};
  return json_number(fill);
}

std::optional<double> double_in_base64(const nlohmann::json& value) {
  constexpr std::size_t kDigits = 11;  // followed by one '='
  const std::string text = value.is_string() ? value.get<std::string>() : std::string();
  if (text.find('=') != kDigits || text.size() != kDigits + 1) return std::nullopt;
  auto bytes = base64(text, sizeof(double));
  if (!bytes) return std::nullopt;
  if (kNativeIsBig) std::reverse(bytes->begin(), bytes->end());
  double number = 0;
  std::memcpy(&number, bytes->data(), sizeof number);
  return number;
}

nlohmann::json number_of_fill(const nlohmann::json& fill, bool of_bool, const std::string& where) {
  if (!of_bool || fill.is_null() || fill == 0 || fill == 1) return fill;
  if (fill.is_boolean()) return fill.get<bool>() ? 1 : 0;
  throw input_error(where, cat("fill_value is ", json_text(fill),
                               ", and of an array of bool it must be true or false; the file is damaged"));
}

}  // namespace weir
