// A file that nobody may read, root included, whom modes do not stop.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace weir {

/// The path of one; empty where this system has none.
inline std::string unreadable_file() {
  const std::string path = "/sys/bus/cpu/drivers_probe";  // the kernel takes writes alone
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) && !std::ifstream(path).is_open() ? path : std::string();
}

}  // namespace weir
