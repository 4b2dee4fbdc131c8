#include "tests/support/faulty_file_system.h"

#include <utility>

#include "format/base/error.h"

namespace weir {
namespace {

class FaultyFile final : public File {
 public:
  FaultyFile(FaultyFileSystem& files, std::unique_ptr<File> real) : files_(files), real_(std::move(real)) {}

  const std::string& path() const override { return real_->path(); }
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    files_.count("write", path());
    real_->write_at(offset, bytes);
  }
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override {
    files_.count("read", path());
    real_->read_at(offset, bytes);
  }
  bool preallocate(std::uint64_t bytes) override {
    files_.count("preallocate", path());
    return real_->preallocate(bytes);
  }
  void clear() override {
    files_.count("clear", path());
    real_->clear();
  }
  void start_writeback() override { real_->start_writeback(); }
  void sync() override {
    files_.count("sync", path());
    real_->sync();
  }
  std::uint64_t size() override { return real_->size(); }
  int descriptor() const override { return real_->descriptor(); }
  std::span<const std::byte> memory() const override { return real_->memory(); }
  bool exclusive() const override { return real_->exclusive(); }
  bool has_its_name() const override { return real_->has_its_name(); }

 private:
  FaultyFileSystem& files_;
  std::unique_ptr<File> real_;
};

}  // namespace

FaultyFileSystem::FaultyFileSystem(FileSystem& real, int fail_at, int errno_value, After after)
    : real_(real), fail_at_(fail_at), errno_value_(errno_value), after_(after) {}

void FaultyFileSystem::count(const std::string& call, const std::string& path) {
  const std::scoped_lock lock(mutex_);
  const auto number = static_cast<int>(calls_.size());
  calls_.push_back(call);
  if (number != fail_at_ && !(failed_ && after_ == After::fails)) return;
  failed_ = true;
  throw io_error(path, "do call " + std::to_string(number) + " (" + call + ")", errno_value_);
}

void FaultyFileSystem::fail_after_rename_to(const std::string& path, int fail_at) {
  awaited_name_ = path;
  fail_after_it_ = fail_at;
}

void FaultyFileSystem::renamed(const std::string& to) {
  const std::scoped_lock lock(mutex_);
  if (to == awaited_name_) fail_at_ = static_cast<int>(calls_.size()) + fail_after_it_;
}

std::vector<std::string> FaultyFileSystem::calls() const {
  const std::scoped_lock lock(mutex_);
  return calls_;
}

std::unique_ptr<File> FaultyFileSystem::create(const std::string& path) {
  count("create", path);
  return std::make_unique<FaultyFile>(*this, real_.create(path));
}

std::unique_ptr<File> FaultyFileSystem::open(const std::string& path) {
  count("open", path);
  return std::make_unique<FaultyFile>(*this, real_.open(path));
}

std::unique_ptr<File> FaultyFileSystem::open_to_read(const std::string& path) {
  count("open_to_read", path);
  return std::make_unique<FaultyFile>(*this, real_.open_to_read(path));
}

std::unique_ptr<File> FaultyFileSystem::create_unnamed(const std::string& directory) {
  count("create_unnamed", directory);
  return std::make_unique<FaultyFile>(*this, real_.create_unnamed(directory));
}

void FaultyFileSystem::rename(const std::string& from, const std::string& to) {
  count("rename", from);
  real_.rename(from, to);
  renamed(to);
}

void FaultyFileSystem::rename_new(const std::string& from, const std::string& to) {
  count("rename_new", from);
  real_.rename_new(from, to);
  renamed(to);
}

bool FaultyFileSystem::link(const std::string& from, const std::string& to) {
  count("link", from);
  return has_links_ && real_.link(from, to);
}

void FaultyFileSystem::remove(const std::string& path) {
  count("remove", path);
  real_.remove(path);
}

void FaultyFileSystem::make_directory(const std::string& path) {
  count("make_directory", path);
  real_.make_directory(path);
}

void FaultyFileSystem::remove_directory(const std::string& path) {
  count("remove_directory", path);
  real_.remove_directory(path);
}

void FaultyFileSystem::sync_directory(const std::string& path) {
  count("sync_directory", path);
  real_.sync_directory(path);
}

bool FaultyFileSystem::exists(const std::string& path) { return real_.exists(path); }

bool FaultyFileSystem::is_replaceable(const std::string& path) { return real_.is_replaceable(path); }

bool FaultyFileSystem::is_memory(const std::string& directory) { return real_.is_memory(directory); }

std::uint64_t FaultyFileSystem::free_bytes(const std::string& directory) {
  return free_bytes_ ? *free_bytes_ : real_.free_bytes(directory);
}

}  // namespace weir
