#include "format/io/real_path.h"

#include <algorithm>
#include <system_error>

namespace weir {

namespace fs = std::filesystem;

fs::path real_path(const std::string& path) {
  std::error_code error;
  fs::path real = fs::weakly_canonical(path, error);
  return error ? fs::path(path).lexically_normal() : real;
}

std::string absolute_real_path(const std::string& path) {
  std::error_code ignored;
  return real_path(fs::absolute(path, ignored).string()).string();
}

bool lies_below(const fs::path& path, const fs::path& directory) {
  return !directory.empty() &&
         std::mismatch(directory.begin(), directory.end(), path.begin(), path.end()).first == directory.end();
}

bool is_there(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

}  // namespace weir
