#include "format/base/toml_reader.h"

#include <vector>

#include "format/base/nearest_name.h"

namespace weir {

void fail_toml(const std::string& path, const toml::source_region& source, const std::string& message) {
  throw Error(ErrorKind::input, cat(path, ':', source.begin.line, ':', source.begin.column, ": ", message));
}

toml::table parse_toml(std::string_view text, const std::string& path) {
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    fail_toml(path, error.source(), cat(error.description(), "; correct the TOML there"));
  }
}

std::string value_found(const toml::node& node) {
  if (const auto* text = node.as_string()) return cat('"', text->get(), '"');
  if (const auto* whole = node.as_integer()) return cat(whole->get());
  if (const auto* number = node.as_floating_point()) return cat(number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  return node.is_array() ? "an array" : node.is_table() ? "a table" : "a date or a time";
}

const toml::node* TomlReader::find(std::string_view key) {
  known_.emplace(key);
  return table_.get(key);
}

double TomlReader::number(const toml::node& node, std::string_view key, Bounds bounds) const {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value) fail(node, cat(key, " is ", value_found(node), ", it must be a number"));
  if (!(*value >= bounds.low && *value <= bounds.high)) {
    fail(node, cat(key, " is ", *value, ", it must be ",
                   bounds.high < 1e300 ? cat("from ", bounds.low, " to ", bounds.high) : "finite and at least ",
                   bounds.high < 1e300 ? "" : cat(bounds.low)));
  }
  return *value;
}

bool TomlReader::read(std::string_view key, double& value, Bounds bounds) {
  const toml::node* node = find(key);
  if (node != nullptr) value = number(*node, key, bounds);
  return node != nullptr;
}

bool TomlReader::read(std::string_view key, std::optional<double>& value, Bounds bounds) {
  double found = 0;
  const bool present = read(key, found, bounds);
  if (present) value = found;
  return present;
}

bool TomlReader::read(std::string_view key, int& value, Bounds bounds) {
  const toml::node* node = find(key);
  if (node == nullptr) return false;
  if (!node->is_integer()) fail(*node, cat(key, " is ", value_found(*node), ", it must be a whole number"));
  value = static_cast<int>(number(*node, key, bounds));
  return true;
}

bool TomlReader::read(std::string_view key, bool& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return false;
  if (!node->is_boolean()) fail(*node, cat(key, " must be true or false"));
  value = node->as_boolean()->get();
  return true;
}

bool TomlReader::read(std::string_view key, std::string& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return false;
  if (!node->is_string()) fail(*node, cat(key, " must be a string"));
  value = *node->value<std::string>();
  return true;
}

bool TomlReader::read(std::string_view key, std::vector<std::string>& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return false;
  if (!node->is_array()) fail(*node, cat(key, " must be an array of strings"));
  value.clear();
  for (const toml::node& element : *node->as_array()) {
    if (!element.is_string()) fail(element, cat(key, " must be an array of strings"));
    value.push_back(element.as_string()->get());
  }
  return true;
}

void TomlReader::finish() const {
  for (const auto& [key, node] : table_) {
    if (known_.contains(key.str())) continue;
    std::string keys;
    for (const std::string& k : known_) keys += cat(keys.empty() ? "" : ", ", k);
    const std::string meant = nearest_name(key.str(), std::vector<std::string>(known_.begin(), known_.end()));
    fail_toml(path_, key.source(),
              cat("unknown key \"", key.str(), "\" in ", name_, "; there are ", keys,
                  meant.empty() ? "" : "; did you mean ", meant, meant.empty() ? "" : "?"));
  }
}

}  // namespace weir
