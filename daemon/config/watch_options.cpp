#include "daemon/config/watch_options.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "compressor/options/conversion_request.h"
#include "daemon/config/regular_file.h"
#include "format/base/exact_text.h"

namespace weir {
namespace {

std::string key_of(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::string value_text(const toml::node& node, const std::string& key, const char* between, const TomlReader& reader) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* number = node.as_floating_point()) return exact_text(number->get());
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty()) {
    reader.fail(node, cat(key, " must be a string, a number or an array of them"));
  }
  std::string joined;
  for (const toml::node& element : *array) {
    if (element.is_array()) reader.fail(element, cat(key, " must not be an array of arrays"));
    joined += cat(joined.empty() ? "" : between, value_text(element, key, between, reader));
  }
  return joined;
}

/// Throws Error(input) with `message` worded for keys. Its place is the last key in the file that the message names,
/// because this key completed the contradiction.
[[noreturn]] void fail_at_key(TomlReader& reader, const toml::table& table, const Message& message,
                              const std::map<std::string, const toml::node*>& nodes) {
  const toml::node* place = &table;
  for (const std::string& key : message.option_keys()) {
    const auto given = nodes.find(key);
    if (given == nodes.end()) continue;
    const bool later = place->is_table() || place->source().begin < given->second->source().begin;
    if (later) place = given->second;
  }
  reader.fail(*place, message.worded(key_wording));
}

}  // namespace

std::vector<std::string> read_watch_options(TomlReader& reader, const toml::table& table) {
  std::vector<std::string> arguments;
  std::map<std::string, const toml::node*> nodes;
  GivenOptions given;
  for (const OptionRow& row : watch_options()) {
    const std::string option(row.key);
    const std::string key = key_of(option);
    const toml::node* node = reader.find(key);
    if (node == nullptr) continue;
    if (row.flag()) {
      const auto* set = node->as_boolean();
      if (set == nullptr) reader.fail(*node, cat(key, " must be true or false"));
      if (!set->get()) continue;
      given[option] = "true";
      arguments.push_back(cat("--", option));
    } else {
      std::string value = value_text(*node, key, row.several ? "\n" : ",", reader);
      if (option == "scene" && !value.empty())
        value = (std::filesystem::path(reader.path()).parent_path() / value).lexically_normal();
      if (value.empty()) continue;
      given[option] = value;
      // Option and value are one word, so that a negative number is never taken for an option.
      for (const std::string& part : row.several ? split(value, '\n') : std::vector{value}) {
        arguments.push_back(cat("--", option, "=", part));
      }
    }
    nodes[option] = node;
  }
  try {
    if (const auto scene = given.find("scene"); scene != given.end()) require_regular_file(scene->second);
    read_conversion_request(given);
  } catch (const Error& error) {
    const auto scene = nodes.find("scene");
    if (error.kind() == ErrorKind::input && scene != nodes.end()) reader.fail(*scene->second, error.what());
    if (error.kind() != ErrorKind::usage) throw;
    fail_at_key(reader, table, error.message(), nodes);
  }
  return arguments;
}

}  // namespace weir
