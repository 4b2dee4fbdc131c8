// The manual page weir.toml(5), of the configuration of `weir watch`.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weir {

/// A key that the configuration has besides the options of conversions.
struct ConfigKey {
  std::string_view table;  ///< "service" or "watch"
  std::string_view key;
  std::string_view standard;  ///< the value where none is given; empty: it must be given
  std::string_view text;      ///< half a sentence
};
std::span<const ConfigKey> config_keys();

/// The page, in the language of man(7).
std::string config_page(const std::string& version);

}  // namespace weir
