#include "format/nvdb_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "format/error.h"

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

std::span<const std::byte> map_file(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe must not block
  if (file.get() < 0) fail_input(path, "open", errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_input(path, "stat", errno);
  if (!S_ISREG(status.st_mode)) {
    throw Error(ErrorKind::input, path + ": not a regular file; give a .nvdb file");
  }
  if (status.st_size == 0) throw Error(ErrorKind::input, path + ": the file is empty; give a .nvdb file");
  const auto bytes = static_cast<std::size_t>(status.st_size);
  void* address = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file.get(), 0);
  if (address == MAP_FAILED) fail_input(path, "map", errno);
  return {static_cast<const std::byte*>(address), bytes};
}

void unmap(std::span<const std::byte> mapping) {
  if (!mapping.empty()) ::munmap(const_cast<std::byte*>(mapping.data()), mapping.size());
}

// Validation may throw; the mapping must not outlive that.
NvdbGrid open_mapped(std::span<const std::byte> mapping, const std::string& path) {
  try {
    return NvdbGrid::open(mapping, path);
  } catch (...) {
    unmap(mapping);
    throw;
  }
}

}  // namespace

NvdbFile::NvdbFile(const std::string& path)
    : path_(path), mapping_(map_file(path)), grid_(open_mapped(mapping_, path)) {}

NvdbFile::~NvdbFile() { unmap(mapping_); }

NvdbFile::NvdbFile(NvdbFile&& other) noexcept
    : path_(std::move(other.path_)), mapping_(std::exchange(other.mapping_, {})), grid_(std::move(other.grid_)) {}

}  // namespace weir
