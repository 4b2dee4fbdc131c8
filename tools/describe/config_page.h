// Writes the manual page weir.toml(5) about the configuration of `weir watch`.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weir {

/// A key of the configuration that is no conversion option.
struct ConfigKey {
  std::string_view table;  ///< "service" or "watch"
  std::string_view key;
  std::string_view standard;  ///< the default; empty: the key must be given
  std::string_view text;      ///< half a sentence
};
std::span<const ConfigKey> config_keys();

/// Returns the page in the language of man(7).
std::string config_page(const std::string& version);

}  // namespace weir
