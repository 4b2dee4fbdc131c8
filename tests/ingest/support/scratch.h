// Helpers of this folder's tests: a temporary directory, files of known bytes, and the message of an expected error.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir {

/// A temporary directory for one test, and files in it.
class Scratch {
 public:
  std::string path(const std::string& name) const { return directory_ / name; }
  std::string write(const std::string& name, std::span<const std::byte> bytes) const {
    std::ofstream file(path(name), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();
    EXPECT_TRUE(file.good()) << path(name);
    return path(name);
  }
  /// Writes `header` bytes of 0xEE, then the values as they lie in memory.
  template <typename T>
  std::string write_values(const std::string& name, const std::vector<T>& values, std::size_t header = 0) const {
    std::vector<std::byte> bytes(header, std::byte{0xEE});
    const auto payload = std::as_bytes(std::span(values));
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return write(name, bytes);
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace weir
