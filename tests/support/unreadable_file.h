// A file that nobody can read, not even root. File modes do not stop root.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace weir {

/// Returns the path of such a file; empty if this system has none.
inline std::string unreadable_file() {
  const std::string path = "/sys/bus/cpu/drivers_probe";  // the kernel accepts only writes
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) && !std::ifstream(path).is_open() ? path : std::string();
}

}  // namespace weir
