// What the tests of this folder share: a directory of their own, files of known
// bytes, and the message of an expected error.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "format/error.h"

namespace weir {

/// A directory named after the running test, removed with all it holds.
class Scratch {
 public:
  Scratch() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    directory_ = std::filesystem::path(::testing::TempDir()) /
                 (std::string("weir_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::string write(const std::string& name, std::span<const std::byte> bytes) const {
    std::ofstream file(path(name), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();
    EXPECT_TRUE(file.good()) << path(name);
    return path(name);
  }
  /// `header` bytes of 0xEE, then the values as they lie in memory.
  template <typename T>
  std::string write_values(const std::string& name, const std::vector<T>& values, std::size_t header = 0) const {
    std::vector<std::byte> bytes(header, std::byte{0xEE});
    const auto payload = std::as_bytes(std::span(values));
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return write(name, bytes);
  }

 private:
  std::filesystem::path directory_;
};

/// Runs `action`, which must throw an Error of `kind`, and returns its message.
template <typename Action>
std::string message_of_error(ErrorKind kind, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

}  // namespace weir
