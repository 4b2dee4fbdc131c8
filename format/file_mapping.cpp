#include "format/file_mapping.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "format/error.h"
#include "format/text.h"

namespace weir {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void fail_input(const std::string& path, const std::string& action, int errno_value) {
  throw Error(ErrorKind::input, io_error(path, action, errno_value).what());
}

}  // namespace

FileMapping::FileMapping(const std::string& path, const std::string& suffix) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe must not block
  if (file.get() < 0) fail_input(path, "open", errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_input(path, "stat", errno);
  if (!S_ISREG(status.st_mode)) {
    throw Error(ErrorKind::input, cat(path, ": not a regular file; give a ", suffix, " file"));
  }
  if (status.st_size == 0) throw Error(ErrorKind::input, cat(path, ": the file is empty; give a ", suffix, " file"));
  const auto bytes = static_cast<std::size_t>(status.st_size);
  void* address = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file.get(), 0);
  if (address == MAP_FAILED) fail_input(path, "map", errno);
  bytes_ = {static_cast<const std::byte*>(address), bytes};
}

FileMapping::~FileMapping() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

FileMapping::FileMapping(FileMapping&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

void FileMapping::release_pages() const {
  ::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_DONTNEED);
}

}  // namespace weir
