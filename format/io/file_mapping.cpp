#include "format/io/file_mapping.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/refused_open.h"
#include "format/process/page_size.h"

namespace weir {
namespace {

#ifndef MADV_POPULATE_READ
constexpr int MADV_POPULATE_READ = 22;  // Linux 5.14; unknown to older C libraries
#endif

constexpr std::uint64_t kSampledPages = 16;

Descriptor open_to_read(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe must not block
  if (!file) throw refused_open(path, "open", errno);
  return file;
}

struct stat status_of(const Descriptor& file, const std::string& path) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw io_error(path, "look at it", errno);
  return status;
}

// Maps with MAP_SHARED, so that pages pinned for a device are those of the page cache: the kernel would copy every page
// of a private mapping first, in case it is written to. A few file systems (FUSE past the page cache) allow private
// mappings only.
void* map(const Descriptor& file, std::size_t bytes) {
  void* shared = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file.get(), 0);
  return shared != MAP_FAILED ? shared : ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file.get(), 0);
}

}  // namespace

FileMapping::FileMapping(const std::string& path, const std::string& suffix)
    : FileMapping(open_to_read(path), path, suffix) {}

FileMapping::FileMapping(Descriptor file, const std::string& path, const std::string& suffix)
    : path_(path), file_(std::move(file)) {
  const struct stat status = status_of(file_, path);
  if (!S_ISREG(status.st_mode)) {
    throw Error(ErrorKind::input, cat(path, ": not a regular file; give a ", suffix, " file"));
  }
  if (status.st_size == 0) throw Error(ErrorKind::input, cat(path, ": the file is empty; give a ", suffix, " file"));
  changed_ = status.st_mtim;
  const auto bytes = static_cast<std::size_t>(status.st_size);
  void* address = map(file_, bytes);
  if (address == MAP_FAILED) throw io_error(path, "map", errno);
  bytes_ = {static_cast<const std::byte*>(address), bytes};
}

FileMapping::~FileMapping() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

FileMapping::FileMapping(FileMapping&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::move(other.file_)),
      changed_(other.changed_),
      bytes_(std::exchange(other.bytes_, {})) {}

void FileMapping::release_pages() const {
  ::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_DONTNEED);
}

bool FileMapping::cached(std::uint64_t offset, std::uint64_t bytes) const {
  const std::uint64_t page = page_bytes();
  const std::uint64_t first = offset / page;
  const std::uint64_t pages = (offset + bytes + page - 1) / page - first;
  const std::uint64_t samples = std::min(pages, kSampledPages);
  for (std::uint64_t s = 0; s < samples; ++s) {
    const std::uint64_t at = (first + s * pages / samples) * page;
    unsigned char resident = 1;
    if (::mincore(const_cast<std::byte*>(bytes_.data()) + at, 1, &resident) == 0 && (resident & 1U) == 0) return false;
  }
  return true;
}

void FileMapping::prefetch(std::uint64_t offset, std::uint64_t bytes) const {
  ::posix_fadvise(file_.get(), static_cast<off_t>(offset), static_cast<off_t>(bytes), POSIX_FADV_WILLNEED);
}

void FileMapping::populate(std::uint64_t offset, std::uint64_t bytes) const {
  const std::uint64_t begin = offset / page_bytes() * page_bytes();
  std::byte* const at = const_cast<std::byte*>(bytes_.data()) + begin;
  int failure = 0;
  do {
    failure = ::madvise(at, offset + bytes - begin, MADV_POPULATE_READ) == 0 ? 0 : errno;
  } while (failure == EINTR || failure == EAGAIN);
  if (failure == 0 || failure == EINVAL || failure == ENOSYS) return;  // EINVAL, ENOSYS: an older system
  check_unchanged();
  // The kernel reports EFAULT for pages that it could not read.
  throw io_error(path_, cat("read bytes ", offset, " to ", offset + bytes), failure == EFAULT ? EIO : failure);
}

void FileMapping::read(std::uint64_t offset, std::span<std::byte> into) const {
  while (!into.empty()) {
    const ssize_t got = ::pread(file_.get(), into.data(), into.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw io_error(path_, cat("read at byte ", offset), errno);
    if (got == 0) {
      check_unchanged();
      throw Error(ErrorKind::input, cat(path_, ": ends at byte ", offset, ", before what was asked for"));
    }
    offset += static_cast<std::uint64_t>(got);
    into = into.subspan(static_cast<std::size_t>(got));
  }
}

void FileMapping::check_unchanged() const {
  const struct stat now = status_of(file_, path_);
  if (static_cast<std::size_t>(now.st_size) != bytes_.size()) {
    throw Error(ErrorKind::input, cat(path_, ": had ", bytes_.size(), " bytes when it was opened, has ", now.st_size,
                                      " now; open it again when it is whole"));
  }
  if (now.st_mtim.tv_sec != changed_.tv_sec || now.st_mtim.tv_nsec != changed_.tv_nsec) {
    throw Error(ErrorKind::input, cat(path_, ": was written to since it was opened; open it again when it is whole"));
  }
}

bool FileMapping::is_at(const std::string& path) const {
  struct stat there {};
  if (::stat(path.c_str(), &there) != 0) return false;
  const struct stat mapped = status_of(file_, path_);
  return there.st_dev == mapped.st_dev && there.st_ino == mapped.st_ino;
}

}  // namespace weir
