#include "format/io/limited_file_system.h"

#include <utility>

namespace weir {
namespace {

class LimitedFile final : public File {
 public:
  LimitedFile(std::unique_ptr<File> file, Bandwidth& bandwidth) : file_(std::move(file)), bandwidth_(bandwidth) {}

  const std::string& path() const override { return file_->path(); }
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    bandwidth_.spend(bytes.size());
    file_->write_at(offset, bytes);
  }
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override {
    file_->read_at(offset, bytes);
    bandwidth_.spend(bytes.size());
  }
  bool preallocate(std::uint64_t bytes) override { return file_->preallocate(bytes); }
  void clear() override { file_->clear(); }
  void start_writeback() override { file_->start_writeback(); }
  void sync() override { file_->sync(); }
  std::uint64_t size() override { return file_->size(); }
  int descriptor() const override { return file_->descriptor(); }
  std::span<const std::byte> memory() const override { return file_->memory(); }
  bool exclusive() const override { return file_->exclusive(); }
  bool has_its_name() const override { return file_->has_its_name(); }

 private:
  std::unique_ptr<File> file_;
  Bandwidth& bandwidth_;
};

class LimitedFileSystem final : public FileSystem {
 public:
  LimitedFileSystem(FileSystem& files, Bandwidth& bandwidth) : files_(files), bandwidth_(bandwidth) {}

  std::unique_ptr<File> create(const std::string& path) override { return limit(files_.create(path)); }
  std::unique_ptr<File> open(const std::string& path) override { return limit(files_.open(path)); }
  std::unique_ptr<File> open_to_read(const std::string& path) override { return limit(files_.open_to_read(path)); }
  std::unique_ptr<File> create_unnamed(const std::string& directory) override {
    return limit(files_.create_unnamed(directory));
  }
  void rename(const std::string& from, const std::string& to) override { files_.rename(from, to); }
  void rename_new(const std::string& from, const std::string& to) override { files_.rename_new(from, to); }
  bool link(const std::string& from, const std::string& to) override { return files_.link(from, to); }
  void remove(const std::string& path) override { files_.remove(path); }
  void make_directory(const std::string& path) override { files_.make_directory(path); }
  void remove_directory(const std::string& path) override { files_.remove_directory(path); }
  void sync_directory(const std::string& path) override { files_.sync_directory(path); }
  bool exists(const std::string& path) override { return files_.exists(path); }
  bool is_replaceable(const std::string& path) override { return files_.is_replaceable(path); }
  bool is_memory(const std::string& directory) override { return files_.is_memory(directory); }
  std::uint64_t free_bytes(const std::string& directory) override { return files_.free_bytes(directory); }

 private:
  std::unique_ptr<File> limit(std::unique_ptr<File> file) {
    return std::make_unique<LimitedFile>(std::move(file), bandwidth_);
  }

  FileSystem& files_;
  Bandwidth& bandwidth_;
};

}  // namespace

std::unique_ptr<FileSystem> limit_file_system(FileSystem& files, Bandwidth& bandwidth) {
  return std::make_unique<LimitedFileSystem>(files, bandwidth);
}

}  // namespace weir
