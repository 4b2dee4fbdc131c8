// The real file system, which calls a test's function before a rename or a removal.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "format/io/file_system.h"

namespace weir {

class SteppedFileSystem final : public FileSystem {
 public:
  std::function<void(const std::string& from)> before_rename = [](const std::string&) {};  ///< before rename_new
  std::function<void(const std::string& path)> before_remove = [](const std::string&) {};

  std::unique_ptr<File> create(const std::string& path) override { return real_->create(path); }
  std::unique_ptr<File> open(const std::string& path) override { return real_->open(path); }
  std::unique_ptr<File> create_unnamed(const std::string& path) override { return real_->create_unnamed(path); }
  void rename(const std::string& from, const std::string& to) override { real_->rename(from, to); }
  void rename_new(const std::string& from, const std::string& to) override {
    before_rename(from);
    real_->rename_new(from, to);
  }
  bool link(const std::string& from, const std::string& to) override { return real_->link(from, to); }
  void remove(const std::string& path) override {
    before_remove(path);
    real_->remove(path);
  }
  void make_directory(const std::string& path) override { real_->make_directory(path); }
  void remove_directory(const std::string& path) override { real_->remove_directory(path); }
  void sync_directory(const std::string& path) override { real_->sync_directory(path); }
  bool exists(const std::string& path) override { return real_->exists(path); }
  bool is_memory(const std::string& directory) override { return real_->is_memory(directory); }
  std::uint64_t free_bytes(const std::string& directory) override { return real_->free_bytes(directory); }

 private:
  std::unique_ptr<FileSystem> real_ = make_posix_file_system();
};

}  // namespace weir
