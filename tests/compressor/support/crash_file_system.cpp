#include "tests/compressor/support/crash_file_system.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"

namespace weir::test {

struct CrashFileSystem::Stored {
  std::mutex mutex;
  Bytes bytes;
  Bytes flushed;            ///< the content of the last flush, if the file has changed since
  bool is_flushed = false;  ///< whether `bytes` is the content of the last flush

  /// Call it before `bytes` changes. A file that does not change after a flush, as most files, is never copied.
  void keep_flushed() {
    if (is_flushed) flushed = bytes;
    is_flushed = false;
  }
};

class CrashFile final : public File {
 public:
  CrashFile(std::shared_ptr<CrashFileSystem::Stored> stored, std::string path)
      : stored_(std::move(stored)), path_(std::move(path)) {}

  const std::string& path() const override { return path_; }
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    const std::scoped_lock lock(stored_->mutex);
    if (bytes.empty()) return;
    stored_->keep_flushed();
    if (stored_->bytes.size() < offset + bytes.size()) stored_->bytes.resize(offset + bytes.size());
    std::memcpy(stored_->bytes.data() + offset, bytes.data(), bytes.size());
  }
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override {
    const std::scoped_lock lock(stored_->mutex);
    if (bytes.empty()) return;
    if (stored_->bytes.size() < offset + bytes.size()) throw Error(ErrorKind::io, cat(path_, ": too short"));
    std::memcpy(bytes.data(), stored_->bytes.data() + offset, bytes.size());
  }
  bool preallocate(std::uint64_t bytes) override {
    const std::scoped_lock lock(stored_->mutex);
    if (stored_->bytes.size() >= bytes) return true;
    stored_->keep_flushed();
    stored_->bytes.resize(bytes);
    return true;
  }
  void clear() override {
    const std::scoped_lock lock(stored_->mutex);
    stored_->keep_flushed();
    stored_->bytes.clear();
  }
  void start_writeback() override {}
  void sync() override {
    const std::scoped_lock lock(stored_->mutex);
    stored_->is_flushed = true;
    stored_->flushed = {};
  }
  std::uint64_t size() override {
    const std::scoped_lock lock(stored_->mutex);
    return stored_->bytes.size();
  }
  std::span<const std::byte> memory() const override {
    const std::scoped_lock lock(stored_->mutex);
    return stored_->bytes;
  }

 private:
  std::shared_ptr<CrashFileSystem::Stored> stored_;
  std::string path_;
};

const CrashFileSystem::Bytes& CrashFileSystem::content(const std::string& path) const {
  static const Bytes none;
  const std::scoped_lock lock(mutex_);
  const auto found = files_.find(path);
  return found == files_.end() ? none : found->second->bytes;
}

CrashFileSystem::Bytes CrashFileSystem::take(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  const auto found = files_.find(path);
  if (found == files_.end()) return {};
  Bytes bytes = std::move(found->second->bytes);
  files_.erase(found);
  return bytes;
}

std::vector<std::string> CrashFileSystem::names() const {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> names;
  for (const auto& [name, bytes] : files_) names.push_back(name);
  return names;
}

std::vector<std::string> CrashFileSystem::directories() const {
  const std::scoped_lock lock(mutex_);
  return {directories_.begin(), directories_.end()};
}

void CrashFileSystem::lose_unflushed() {
  const std::scoped_lock lock(mutex_);
  files_ = durable_files_;
  std::erase_if(files_, [&](const auto& file) {
    const std::string directory = directory_of(file.first);
    return directories_.contains(directory) && !durable_directories_.contains(directory);
  });
  durable_files_ = files_;
  directories_ = durable_directories_;
  for (const auto& [name, stored] : files_) {
    if (!stored->is_flushed) stored->bytes = stored->flushed;
  }
}

std::unique_ptr<File> CrashFileSystem::create(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  auto stored = std::make_shared<Stored>();
  files_[path] = stored;
  return std::make_unique<CrashFile>(stored, path);
}

std::unique_ptr<File> CrashFileSystem::open(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  std::shared_ptr<Stored>& stored = files_[path];
  if (stored == nullptr) stored = std::make_shared<Stored>();
  return std::make_unique<CrashFile>(stored, path);
}

std::unique_ptr<File> CrashFileSystem::create_unnamed(const std::string& directory) {
  return std::make_unique<CrashFile>(std::make_shared<Stored>(), directory + " (temporary file)");
}

void CrashFileSystem::rename(const std::string& from, const std::string& to) {
  if (link(from, to)) remove(from);
}

void CrashFileSystem::rename_new(const std::string& from, const std::string& to) {
  if (exists(to)) throw Error(ErrorKind::io, cat(to, ": exists"));
  rename(from, to);
}

bool CrashFileSystem::link(const std::string& from, const std::string& to) {
  const std::scoped_lock lock(mutex_);
  const auto found = files_.find(from);
  if (found == files_.end()) throw Error(ErrorKind::io, cat(from, ": missing"));
  files_[to] = found->second;
  return true;
}

void CrashFileSystem::remove(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  files_.erase(path);
}

void CrashFileSystem::make_directory(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  directories_.insert(path);
}

void CrashFileSystem::remove_directory(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  for (const auto& [name, stored] : files_) {
    if (directory_of(name) == path) throw Error(ErrorKind::io, cat(path, ": is not empty"));
  }
  directories_.erase(path);
}

void CrashFileSystem::sync_directory(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  for (const std::string& directory : directories_) {
    if (directory_of(directory) == path) durable_directories_.insert(directory);
  }
  std::erase_if(durable_directories_, [&](const std::string& directory) {
    return directory_of(directory) == path && !directories_.contains(directory);
  });
  // Makes everything durable that happened to files that have or had a name here, so that no rename is cut in two.
  std::set<const Stored*> concerned;
  for (const Files* files : {&files_, &durable_files_}) {
    for (const auto& [name, stored] : *files) {
      if (directory_of(name) == path) concerned.insert(stored.get());
    }
  }
  std::erase_if(durable_files_, [&](const auto& file) { return concerned.contains(file.second.get()); });
  for (const auto& [name, stored] : files_) {
    if (concerned.contains(stored.get())) durable_files_[name] = stored;
  }
}

bool CrashFileSystem::exists(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  return path == "." || files_.contains(path) || directories_.contains(path);
}

bool CrashFileSystem::is_memory(const std::string&) { return false; }
std::uint64_t CrashFileSystem::free_bytes(const std::string&) { return std::uint64_t{1} << 40U; }

}  // namespace weir::test
