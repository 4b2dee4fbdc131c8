#include "compressor/forecast/scratch_file_system.h"

#include <cerrno>
#include <utility>

#include "compressor/resume/work_directory.h"
#include "format/base/error.h"
#include "format/io/output_names.h"
#include "format/sidecar/sidecar.h"

namespace weir {

// A file of the real file system that reports the name that the conversion gave it.
class ScratchFileSystem::ScratchFile final : public File {
 public:
  ScratchFile(std::shared_ptr<File> file, std::string path) : file_(std::move(file)), path_(std::move(path)) {}

  const std::string& path() const override { return path_; }
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override { file_->write_at(offset, bytes); }
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override { file_->read_at(offset, bytes); }
  bool preallocate(std::uint64_t bytes) override { return file_->preallocate(bytes); }
  void clear() override { file_->clear(); }
  void start_writeback() override { file_->start_writeback(); }
  void sync() override { file_->sync(); }
  std::uint64_t size() override { return file_->size(); }
  int descriptor() const override { return file_->descriptor(); }
  std::span<const std::byte> memory() const override { return file_->memory(); }

 private:
  std::shared_ptr<File> file_;
  std::string path_;
};

ScratchFileSystem::ScratchFileSystem(FileSystem& files, const std::string& output)
    : files_(files), output_(output), sidecar_(sidecar_path(output)), hidden_(hidden_directory_of(output)) {}

std::unique_ptr<File> ScratchFileSystem::create(const std::string& path) {
  std::shared_ptr<File> file = files_.create_unnamed(directory_of(path));
  const std::scoped_lock lock(mutex_);
  named_[path] = file;
  return std::make_unique<ScratchFile>(std::move(file), path);
}

std::unique_ptr<File> ScratchFileSystem::open(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  const auto found = named_.find(path);
  if (found == named_.end()) throw io_error(path, "open", ENOENT);
  return std::make_unique<ScratchFile>(found->second, path);
}

std::unique_ptr<File> ScratchFileSystem::create_unnamed(const std::string& directory) {
  // The hidden directory beside the output does not exist, because make_directory() makes none.
  const std::string& place = directory == hidden_ ? directory_of(output_) : directory;
  return std::make_unique<ScratchFile>(files_.create_unnamed(place), directory);
}

void ScratchFileSystem::rename(const std::string& from, const std::string& to) {
  const std::scoped_lock lock(mutex_);
  auto moved = named_.extract(from);
  if (moved.empty()) return;
  moved.key() = to;
  named_.erase(to);
  named_.insert(std::move(moved));
}

void ScratchFileSystem::remove(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  named_.erase(path);
}

bool ScratchFileSystem::exists(const std::string& path) {
  {
    const std::scoped_lock lock(mutex_);
    if (named_.contains(path)) return true;
  }
  const bool beside = path.starts_with(output_) && path != output_ && path != sidecar_;
  if (beside || path.starts_with(hidden_)) return false;
  return files_.exists(path);
}

}  // namespace weir
