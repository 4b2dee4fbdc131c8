// Writes to a file of a memory file system (tmpfs) through a mapping. The system lets only one thread at a time write()
// to a file; 16 threads that copy into its pages take a fifth of the time.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "format/io/file_system.h"

namespace weir {

/// Clears the pages of the first `bytes` of a file of a memory file system, until `stop` is set. Their space is
/// reserved and nothing is written there yet. The system maps cleared pages 16 at a time, others one at a time: 16
/// threads then copy 0.5 GB in 0.013 s instead of 0.032 s. Clearing takes one thread 0.1 s, which it should spend
/// beside other work.
void clear_reserved_pages(File& file, std::uint64_t bytes, const std::atomic<bool>& stop);

/// Maps the first bytes of a file. Their space is reserved, so that no write finds the file system full. While the
/// mapping exists, written pages count as the process's memory; if another process truncates the file, this one ends by
/// SIGBUS, as with any mapping. memory() is the mapping; all other calls go to the file.
class MappedWrites final : public File {
 public:
  /// `file` must outlive the object. Returns null if the file cannot be mapped.
  static std::unique_ptr<MappedWrites> of(File& file, std::uint64_t bytes);
  ~MappedWrites() override;

  const std::string& path() const override { return file_.path(); }
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override;
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override { file_.read_at(offset, bytes); }
  bool preallocate(std::uint64_t bytes) override { return file_.preallocate(bytes); }
  void clear() override { file_.clear(); }
  void start_writeback() override { file_.start_writeback(); }
  void sync() override { file_.sync(); }
  std::uint64_t size() override { return file_.size(); }
  int descriptor() const override { return file_.descriptor(); }
  std::span<const std::byte> memory() const override { return mapped_; }
  bool exclusive() const override { return file_.exclusive(); }

 private:
  MappedWrites(File& file, std::span<std::byte> mapped) : file_(file), mapped_(mapped) {}

  File& file_;
  std::span<std::byte> mapped_;
};

}  // namespace weir
