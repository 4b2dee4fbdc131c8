#include "format/base/kernel_table.h"

#include <fstream>

namespace weir {

std::uint64_t number_in_table(const std::string& path, const std::string& key) {
  std::ifstream lines(path);
  std::string word;
  while (lines >> word) {
    if (word != key) continue;
    std::uint64_t number = 0;
    lines >> number;
    return number;
  }
  return 0;
}

std::optional<std::uint64_t> number_in_file(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  return file >> number ? std::optional(number) : std::nullopt;
}

}  // namespace weir
