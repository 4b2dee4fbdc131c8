// Writes and reads the keys of a sidecar as JSON from one description: both classes have the same functions.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/index.h"
#include "format/base/json_text.h"
#include "format/base/text.h"

namespace weir {

class JsonWriter {
 public:
  using Json = nlohmann::ordered_json;

  template <typename Fields>
  void object(const char* key, const Fields& fields) {
    Json* const outer = at_;
    at_ = &((*outer)[key] = Json::object());
    fields();
    at_ = outer;
  }

  template <typename T, typename Fields>
  void optional_object(const char* key, const std::optional<T>& value, const Fields& fields) {
    if (value) object(key, [&] { fields(*value); });
  }

  template <typename T>
  void field(const char* key, const T& value) {
    (*at_)[key] = value;
  }
  void field(const char* key, const std::optional<double>& value) { (*at_)[key] = value ? Json(*value) : Json(); }
  void field(const char* key, const Index3& i) { (*at_)[key] = array(i); }
  void field(const char* key, const Box& box) { (*at_)[key] = {array(box.lo), array(box.hi)}; }
  template <typename T>
  void optional_field(const char* key, const T& value) {
    if (value != T()) field(key, value);
  }
  void hex_field(const char* key, std::uint32_t value) {
    std::array<char, 9> text{};
    std::snprintf(text.data(), text.size(), "%08x", value);
    (*at_)[key] = text.data();
  }

  const Json& document() const { return document_; }

 private:
  static std::array<std::int64_t, 3> array(const Index3& i) { return {i.x, i.y, i.z}; }

  Json document_ = Json::object();
  Json* at_ = &document_;
};

class JsonReader {
 public:
  using Json = nlohmann::json;

  JsonReader(const Json& document, const std::string& path) : path_(path), at_(&document) {}

  template <typename Fields>
  void object(const char* key, const Fields& fields) {
    const Json* const outer = at_;
    const std::string outer_prefix = prefix_;
    at_ = &find(key);
    if (!at_->is_object()) fail(key, "an object", *at_);
    prefix_ += cat(key, '.');
    fields();
    at_ = outer;
    prefix_ = outer_prefix;
  }

  template <typename T, typename Fields>
  void optional_object(const char* key, std::optional<T>& value, const Fields& fields) {
    value.reset();
    if (!at_->contains(key)) return;
    value = T();
    object(key, [&] { fields(*value); });
  }

  template <typename T>
  void field(const char* key, T& value) {
    read(key, find(key), value);
  }

  template <typename T>
  void optional_field(const char* key, T& value) {
    value = T();
    if (at_->contains(key)) field(key, value);
  }

  void hex_field(const char* key, std::uint32_t& value) {
    std::string text;
    field(key, text);
    const bool digits =
        std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
    if (text.size() != 8 || !digits) fail(key, "8 lower-case hex digits", find(key));
    value = static_cast<std::uint32_t>(std::stoul(text, nullptr, 16));
  }

 private:
  // Returns `value` for a message. Does not print arrays and objects: they may be large, and nested too deep for a
  // recursion.
  static std::string shown(const Json& value) {
    if (value.is_array()) return cat("an array of ", value.size());
    if (value.is_object()) return "an object";
    return json_text(value).substr(0, 60);
  }

  [[noreturn]] void fail(const std::string& key, const char* expected, const Json& found) const {
    throw Error(ErrorKind::input, cat(path_, ": key ", prefix_, key, ": expected ", expected, ", found ", shown(found),
                                      "; write the sidecar again with weir convert"));
  }

  const Json& find(const char* key) const {
    const auto found = at_->find(key);
    if (found == at_->end()) {
      throw Error(ErrorKind::input,
                  cat(path_, ": key ", prefix_, key, " is missing; write the sidecar again with weir convert"));
    }
    return *found;
  }

  void read(const std::string& key, const Json& from, std::string& to) const {
    if (!from.is_string()) fail(key, "a string", from);
    to = from.get<std::string>();
  }
  void read(const std::string& key, const Json& from, bool& to) const {
    if (!from.is_boolean()) fail(key, "true or false", from);
    to = from.get<bool>();
  }
  void read(const std::string& key, const Json& from, std::uint64_t& to) const {
    if (!from.is_number_unsigned()) fail(key, "a whole number, not negative", from);
    to = from.get<std::uint64_t>();
  }
  void read(const std::string& key, const Json& from, std::int64_t& to) const {
    const bool fits = from.is_number_unsigned()
                          ? from.get<std::uint64_t>() <= std::uint64_t{std::numeric_limits<std::int64_t>::max()}
                          : from.is_number_integer();
    if (!fits) fail(key, "a whole number", from);
    to = from.get<std::int64_t>();
  }
  void read(const std::string& key, const Json& from, double& to) const {
    if (!from.is_number() && !from.is_null()) fail(key, "a number or null", from);
    to = from.is_null() ? std::numeric_limits<double>::quiet_NaN() : from.get<double>();
  }
  void read(const std::string& key, const Json& from, std::optional<double>& to) const {
    to.reset();
    if (!from.is_null()) read(key, from, to.emplace());
  }
  template <typename T, std::size_t N>
  void read(const std::string& key, const Json& from, std::array<T, N>& to) const {
    if (!from.is_array() || from.size() != N) fail(key, N == 2 ? "an array of 2" : "an array of 3", from);
    for (std::size_t i = 0; i < N; ++i) read(cat(key, '[', i, ']'), from[i], to[i]);
  }
  void read(const std::string& key, const Json& from, Index3& to) const {
    std::array<std::int64_t, 3> values{};
    read(key, from, values);
    to = {values[0], values[1], values[2]};
  }
  void read(const std::string& key, const Json& from, Box& to) const {
    std::array<Index3, 2> corners;
    read(key, from, corners);
    to = {corners[0], corners[1]};
  }
  template <typename T>
  void read(const std::string& key, const Json& from, std::vector<T>& to) const {
    if (!from.is_array()) fail(key, "an array", from);
    to.resize(from.size());
    for (std::size_t i = 0; i < to.size(); ++i) read(cat(key, '[', i, ']'), from[i], to[i]);
  }
  void read(const std::string& key, const Json& from, std::map<std::string, std::string>& to) const {
    if (!from.is_object()) fail(key, "an object of strings", from);
    to.clear();
    for (const auto& [name, value] : from.items()) read(cat(key, '.', name), value, to[name]);
  }

  const std::string& path_;
  const Json* at_;
  std::string prefix_;
};

}  // namespace weir
