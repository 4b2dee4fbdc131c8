// Lists the files in a directory of a test.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

namespace weir {

/// Names and contents of all files of a directory.
using Listing = std::map<std::string, std::string>;

inline Listing listing_of(const std::filesystem::path& directory) {
  Listing all;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    std::ifstream file(entry.path(), std::ios::binary);
    all[entry.path().filename().string()] = std::string(std::istreambuf_iterator<char>(file), {});
  }
  return all;
}

}  // namespace weir
