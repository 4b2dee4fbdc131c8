// Reads a TOML table key by key: checks the type and range of every value, and reports a key that no caller asked for.
// Messages are "PATH:LINE:COLUMN: ...".
#pragma once

#include <toml++/toml.h>

#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

/// Throws Error(input) that names `path` and the place of `source` in it.
[[noreturn]] void fail_toml(const std::string& path, const toml::source_region& source, const std::string& message);

/// Parses a whole document. Throws Error(input) with the parser's place and reason.
toml::table parse_toml(std::string_view text, const std::string& path);

/// Returns `node` for a message: "90d" in quotes, true, 1.5; for a node that is not a single value, its type: an array.
std::string value_found(const toml::node& node);

/// Inclusive bounds of a number.
struct Bounds {
  double low = -1e300;
  double high = 1e300;
};

class TomlReader {
 public:
  /// `table` and `path` must outlive the reader. `name`, such as "[camera]", is for messages.
  TomlReader(const toml::table& table, std::string name, const std::string& path)
      : table_(table), name_(std::move(name)), path_(path) {}

  const std::string& path() const { return path_; }

  /// Returns the node of `key`, null if it is absent; the key counts as known from now on.
  const toml::node* find(std::string_view key);
  /// Each read() returns whether the key is there, and leaves `value` as it is if not.
  bool read(std::string_view key, double& value, Bounds bounds = {});
  bool read(std::string_view key, std::optional<double>& value, Bounds bounds = {});
  bool read(std::string_view key, int& value, Bounds bounds);
  bool read(std::string_view key, bool& value);
  bool read(std::string_view key, std::string& value);
  /// Reads an array of strings.
  bool read(std::string_view key, std::vector<std::string>& value);
  /// Reads an array of exactly N numbers.
  template <std::size_t N>
  bool read(std::string_view key, std::array<double, N>& value, Bounds bounds = {}) {
    const toml::node* node = find(key);
    if (node != nullptr) value = numbers<N>(*node, key, bounds);
    return node != nullptr;
  }
  template <std::size_t N>
  bool read(std::string_view key, std::optional<std::array<double, N>>& value, Bounds bounds = {}) {
    std::array<double, N> found{};
    const bool present = read(key, found, bounds);
    if (present) value = found;
    return present;
  }
  /// Returns `node` as N numbers.
  template <std::size_t N>
  std::array<double, N> numbers(const toml::node& node, std::string_view key, Bounds bounds) const {
    std::array<double, N> values{};
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != N) fail(node, cat(key, " must be an array of ", N, " numbers"));
    for (std::size_t i = 0; i < N; ++i) values[i] = number(*array->get(i), key, bounds);
    return values;
  }
  /// Throws for the first key that no call asked for.
  void finish() const;
  [[noreturn]] void fail(const toml::node& node, const std::string& message) const {
    fail_toml(path_, node.source(), message);
  }

 private:
  double number(const toml::node& node, std::string_view key, Bounds bounds) const;

  const toml::table& table_;
  std::string name_;
  const std::string& path_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace weir
