#include "daemon/config/convert_syntax.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

std::string key_of(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// The shortest text that parses back to `value`.
std::string number_text(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string value_text(const toml::node& node, const std::string& key, const TomlReader& reader) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* number = node.as_floating_point()) return number_text(number->get());
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty()) {
    reader.fail(node, cat(key, " must be a string, a number or an array of them"));
  }
  std::string joined;
  for (const toml::node& element : *array) {
    if (element.is_array()) reader.fail(element, cat(key, " must not be an array of arrays"));
    joined += cat(joined.empty() ? "" : ",", value_text(element, key, reader));
  }
  return joined;
}

bool is_option_character(char c) { return (c >= 'a' && c <= 'z') || c == '-'; }

/// A message of the command line, said of keys: options among `nodes` or not, but known to `syntax`, lose their
/// dashes. `place` becomes the last of the given keys that it speaks of, the one that made it wrong.
std::string said_of_keys(const std::string& message, const ConvertSyntax& syntax,
                         const std::map<std::string, const toml::node*>& nodes, const toml::node*& place) {
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    std::size_t end = at;
    if (message.compare(at, 2, "--") == 0) {
      end = at + 2;
      while (end < message.size() && is_option_character(message[end])) ++end;
    }
    const std::string name = end == at ? "" : message.substr(at + 2, end - at - 2);
    const auto is_name = [&](const ConvertSyntax::Option& option) { return option.name == name; };
    if (std::none_of(syntax.options.begin(), syntax.options.end(), is_name)) {
      text += message[at++];
      continue;
    }
    text += key_of(name);
    at = end;
    const auto given = nodes.find(name);
    if (given == nodes.end()) continue;
    const toml::source_position begin = given->second->source().begin;
    if (place->is_table() || place->source().begin < begin) place = given->second;
  }
  return text;
}

}  // namespace

std::vector<std::string> read_convert_options(TomlReader& reader, const toml::table& table,
                                              const ConvertSyntax& syntax) {
  std::vector<std::string> arguments;
  std::map<std::string, const toml::node*> nodes;
  for (const ConvertSyntax::Option& option : syntax.options) {
    const std::string key = key_of(option.name);
    const toml::node* node = reader.find(key);
    if (node == nullptr) continue;
    nodes[option.name] = node;
    if (option.flag) {
      const auto* set = node->as_boolean();
      if (set == nullptr) reader.fail(*node, cat(key, " must be true or false"));
      if (set->get()) arguments.push_back(cat("--", option.name));
    } else {
      std::string value = value_text(*node, key, reader);
      if (option.path) value = (std::filesystem::path(reader.path()).parent_path() / value).lexically_normal();
      // One word, so that a negative number is never taken for an option.
      arguments.push_back(cat("--", option.name, "=", value));
    }
  }
  try {
    syntax.check(arguments);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) throw;
    const toml::node* place = &table;
    const std::string message = said_of_keys(error.what(), syntax, nodes, place);
    reader.fail(*place, message);
  }
  return arguments;
}

}  // namespace weir
