// A file system in which a conversion leaves nothing behind, because its files have no names.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "format/io/file_system.h"

namespace weir {

/// Lies over the real file system `files`. It shows the real directories, `output` and its sidecar, but nothing that
/// another conversion to `output` keeps beside them. Created files lie in the real directories without a name and
/// vanish with their last user. Renaming, removing and making directories change nothing there. Thread-safe. `files`
/// must outlive the object and its files.
class ScratchFileSystem final : public FileSystem {
 public:
  ScratchFileSystem(FileSystem& files, const std::string& output);

  std::unique_ptr<File> create(const std::string& path) override;
  std::unique_ptr<File> open(const std::string& path) override;
  std::unique_ptr<File> create_unnamed(const std::string& directory) override;
  void rename(const std::string& from, const std::string& to) override;
  void rename_new(const std::string& from, const std::string& to) override { rename(from, to); }
  bool link(const std::string&, const std::string&) override { return true; }
  void remove(const std::string& path) override;
  void make_directory(const std::string&) override {}
  void remove_directory(const std::string&) override {}
  void sync_directory(const std::string&) override {}
  bool exists(const std::string& path) override;
  bool is_replaceable(const std::string& path) override { return files_.is_replaceable(path); }
  bool is_memory(const std::string& directory) override { return files_.is_memory(directory); }
  std::uint64_t free_bytes(const std::string& directory) override { return files_.free_bytes(directory); }

 private:
  class ScratchFile;

  FileSystem& files_;
  std::string output_;
  std::string sidecar_;
  std::string hidden_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<File>> named_;
};

}  // namespace weir
