#include "format/io/memory_file_system.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <shared_mutex>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/reused_pages.h"
#include "format/process/page_size.h"
#include "format/process/process_memory.h"

namespace weir {

// A mapping that grows. Several threads read and write at the same time; only growing excludes them, because it may
// move the bytes.
class MemoryFileSystem::Pages {
 public:
  explicit Pages(PagesOf pages) : pages_(pages) {}
  ~Pages() { unmap(); }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;

  void write_at(const std::string& path, std::uint64_t offset, std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    if (offset + bytes.size() < offset) throw io_error(path, cat("write at offset ", offset), EFBIG);
    std::shared_lock reading(mutex_);
    if (offset + bytes.size() > size_) {
      reading.unlock();
      grow(offset + bytes.size(), true);
      reading.lock();
    }
    std::memcpy(begin_ + offset, bytes.data(), bytes.size());
  }

  void read_at(const std::string& path, std::uint64_t offset, std::span<std::byte> bytes) const {
    const std::shared_lock lock(mutex_);
    if (offset > size_ || bytes.size() > size_ - offset) {
      throw Error(ErrorKind::io, cat(path, ": has ", size_, " bytes, asked for ", bytes.size(), " at offset ", offset));
    }
    if (!bytes.empty()) std::memcpy(bytes.data(), begin_ + offset, bytes.size());
  }

  /// Grows the file to at least `bytes`. With `ahead` it reserves room for more, so that a file written piece by piece
  /// is not moved for each piece.
  void grow(std::uint64_t bytes, bool ahead) {
    const std::scoped_lock lock(mutex_);
    if (bytes > capacity_) {
      constexpr std::uint64_t kLeast = std::uint64_t{1} << 20U;
      const std::uint64_t wanted = ahead ? std::max({bytes, capacity_ + capacity_ / 2, kLeast}) : bytes;
      if (begin_ == nullptr && pages_ == PagesOf::earlier_files && take_earlier(wanted)) {
        size_ = bytes;
        return;
      }
      const std::uint64_t capacity = round_up_to_page(wanted);
      void* const moved = begin_ == nullptr ? ::mmap(nullptr, capacity, PROT_READ | PROT_WRITE,
                                                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)
                                            : ::mremap(begin_, capacity_, capacity, MREMAP_MAYMOVE);
      if (moved == MAP_FAILED) {  // the path is a name that only weir knows
        throw Error(ErrorKind::internal, cat("out of memory: a file made in it needs ", capacity,
                                             " bytes; free some, or ask for a smaller file"));
      }
      begin_ = static_cast<std::byte*>(moved);
      capacity_ = capacity;
      // Large pages cause fewer page faults. They are used only for files so large that a page more does not count.
      constexpr std::uint64_t kLarge = std::uint64_t{16} << 20U;
      if (capacity >= kLarge) ::madvise(begin_, capacity, MADV_HUGEPAGE);
    }
    size_ = std::max(size_, bytes);
  }

  void clear() {
    const std::scoped_lock lock(mutex_);
    unmap();
  }

  std::span<const std::byte> bytes() const {
    const std::shared_lock lock(mutex_);
    return {begin_, size_};
  }

 private:
  bool take_earlier(std::uint64_t bytes) {
    const std::span<std::byte> earlier = ReusedPages::of_process().take(bytes);
    if (earlier.empty()) return false;
    begin_ = earlier.data();
    capacity_ = earlier.size();
    return true;
  }

  void unmap() {
    if (pages_ == PagesOf::earlier_files) {
      ReusedPages::of_process().give_back({begin_, capacity_});
    } else if (begin_ != nullptr) {
      ::munmap(begin_, capacity_);
    }
    begin_ = nullptr;
    capacity_ = 0;
    size_ = 0;
  }

  const PagesOf pages_;
  mutable std::shared_mutex mutex_;
  std::byte* begin_ = nullptr;
  std::uint64_t capacity_ = 0;  // bytes mapped
  std::uint64_t size_ = 0;      // bytes of the file
};

class MemoryFileSystem::PagesFile final : public File {
 public:
  PagesFile(std::shared_ptr<Pages> pages, std::string path) : pages_(std::move(pages)), path_(std::move(path)) {}

  const std::string& path() const override { return path_; }
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    pages_->write_at(path_, offset, bytes);
  }
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override { pages_->read_at(path_, offset, bytes); }
  bool preallocate(std::uint64_t bytes) override {
    pages_->grow(bytes, false);
    return true;
  }
  void clear() override { pages_->clear(); }
  void start_writeback() override {}
  void sync() override {}
  std::uint64_t size() override { return pages_->bytes().size(); }
  std::span<const std::byte> memory() const override { return pages_->bytes(); }

 private:
  std::shared_ptr<Pages> pages_;
  std::string path_;
};

MemoryFileSystem::MemoryFileSystem(PagesOf pages) : pages_(pages) {}
MemoryFileSystem::~MemoryFileSystem() = default;

std::shared_ptr<MemoryFileSystem::Pages> MemoryFileSystem::find(const std::string& path) const {
  const auto found = files_.find(path);
  if (found == files_.end()) throw io_error(path, "find", ENOENT);
  return found->second;
}

std::span<const std::byte> MemoryFileSystem::content(const std::string& path) const {
  const std::scoped_lock lock(mutex_);
  return find(path)->bytes();
}

std::unique_ptr<File> MemoryFileSystem::create(const std::string& path) {
  auto file = open(path);
  file->clear();
  return file;
}

std::unique_ptr<File> MemoryFileSystem::open(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  std::shared_ptr<Pages>& pages = files_[path];
  if (pages == nullptr) pages = std::make_shared<Pages>(pages_);
  return std::make_unique<PagesFile>(pages, path);
}

std::unique_ptr<File> MemoryFileSystem::open_to_read(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  return std::make_unique<PagesFile>(find(path), path);
}

std::unique_ptr<File> MemoryFileSystem::create_unnamed(const std::string& directory) {
  return std::make_unique<PagesFile>(std::make_shared<Pages>(pages_), directory + " (temporary file in memory)");
}

void MemoryFileSystem::rename(const std::string& from, const std::string& to) {
  const std::scoped_lock lock(mutex_);
  const auto pages = find(from);
  files_.erase(from);
  files_[to] = pages;
}

void MemoryFileSystem::rename_new(const std::string& from, const std::string& to) {
  const std::scoped_lock lock(mutex_);
  const auto pages = find(from);
  if (!files_.emplace(to, pages).second) throw io_error(from, "rename to " + to, EEXIST);
  files_.erase(from);
}

bool MemoryFileSystem::link(const std::string& from, const std::string& to) {
  const std::scoped_lock lock(mutex_);
  if (!files_.emplace(to, find(from)).second) throw io_error(from, "link to " + to, EEXIST);
  return true;
}

void MemoryFileSystem::remove(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  files_.erase(path);
}

bool MemoryFileSystem::exists(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  return path == "." || files_.count(path) > 0;
}

std::uint64_t MemoryFileSystem::free_bytes(const std::string&) { return available_bytes(); }

}  // namespace weir
