// A file mapped read-only. Owns the mapping.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace weir {

class FileMapping {
 public:
  /// Throws Error(input) for a missing, empty or no regular file; `suffix`, ".nvdb", is what should have been given.
  FileMapping(const std::string& path, const std::string& suffix);
  ~FileMapping();
  FileMapping(FileMapping&& other) noexcept;
  FileMapping& operator=(FileMapping&&) = delete;
  FileMapping(const FileMapping&) = delete;
  FileMapping& operator=(const FileMapping&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }
  /// Gives the pages looked at so far back, for mapped ones count as the process's memory; they stay in the page
  /// cache and are mapped again when they are looked at. Any thread may call it at any time.
  void release_pages() const;

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace weir
