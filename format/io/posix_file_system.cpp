#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <system_error>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_size_signal.h"
#include "format/io/file_system.h"

namespace weir {
namespace {

class PosixFile final : public File {
 public:
  PosixFile(int descriptor, std::string path, bool exclusive)
      : descriptor_(descriptor), path_(std::move(path)), place_(path_), exclusive_(exclusive) {}
  /// Returns a file without a name in `directory`, the path that its errors carry for programs.
  static std::unique_ptr<PosixFile> unnamed(int descriptor, const std::string& directory) {
    auto file = std::make_unique<PosixFile>(descriptor, directory + " (temporary file)", true);
    file->place_ = directory;
    return file;
  }
  ~PosixFile() override { ::close(descriptor_); }
  PosixFile(const PosixFile&) = delete;
  PosixFile& operator=(const PosixFile&) = delete;

  const std::string& path() const override { return path_; }

  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    const NoFileSizeSignal no_signal;
    while (!bytes.empty()) {
      const ssize_t done = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) throw failed(cat("write ", bytes.size(), " bytes at offset ", offset), errno);
      offset += static_cast<std::uint64_t>(done);
      bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
  }

  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override {
    while (!bytes.empty()) {
      const ssize_t done = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) throw failed(cat("read ", bytes.size(), " bytes at offset ", offset), errno);
      if (done == 0)
        throw Error(ErrorKind::io, cat(path_, ": ends at offset ", offset, ", expected ", bytes.size(), " bytes more"));
      offset += static_cast<std::uint64_t>(done);
      bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
  }

  bool preallocate(std::uint64_t bytes) override {
    const NoFileSizeSignal no_signal;
    // fallocate() instead of posix_fallocate(): the latter writes zeros if the file system cannot reserve.
    int status = 0;
    do {
      status = bytes == 0 ? 0 : ::fallocate(descriptor_, 0, 0, static_cast<off_t>(bytes));
    } while (status != 0 && errno == EINTR);
    if (status == 0) return true;
    if (errno != EOPNOTSUPP && errno != ENOSYS) throw failed(cat("reserve ", bytes, " bytes"), errno);
    if (::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) throw failed(cat("set the size to ", bytes), errno);
    return false;
  }

  void clear() override {
    if (::ftruncate(descriptor_, 0) != 0) throw failed("set the size to 0", errno);
  }

  void start_writeback() override { ::sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE); }

  void sync() override {
    if (::fsync(descriptor_) != 0) throw failed("flush to the device", errno);
  }

  std::uint64_t size() override {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) throw failed("read the size", errno);
    return static_cast<std::uint64_t>(status.st_size);
  }

  int descriptor() const override { return descriptor_; }
  bool exclusive() const override { return exclusive_; }
  void set_exclusive() { exclusive_ = true; }

  bool has_its_name() const override {
    struct stat mine {};
    struct stat named {};
    if (::fstat(descriptor_, &mine) != 0) {
      if (errno == ESTALE) return false;  // another client of the file server has removed it
      throw failed("look at", errno);
    }
    if (::lstat(path_.c_str(), &named) != 0) {
      if (errno == ENOENT) return false;
      throw failed("look at", errno);
    }
    return mine.st_ino == named.st_ino && mine.st_dev == named.st_dev;
  }

 private:
  Error failed(const Message& action, int errno_value) const {
    return {ErrorKind::io, io_error(path_, action, errno_value).message(), SystemFailure{errno_value, place_}};
  }

  int descriptor_;
  std::string path_;   ///< the path as messages name it
  std::string place_;  ///< the path on its file system: `path_`, or the directory of a file without a name
  bool exclusive_;
};

[[noreturn]] void refuse_foreign(const std::string& path, const char* what) {
  throw usage_error(cat(path, ": ", what, ", so it is none of weir's own files; remove it or choose another output"));
}

bool is_link(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISLNK(status.st_mode);
}

// The error of a new file or directory that cannot be created although its own directory was there at the check.
Error not_created(const std::string& path, const char* action, int errno_value) {
  const Error error = io_error(path, action, errno_value);
  if (errno_value != ENOENT) return error;
  return {ErrorKind::io, compose(error.message(), "; its directory is gone or takes no files, choose another place"),
          error.system_failure()};
}

class PosixFileSystem final : public FileSystem {
 public:
  explicit PosixFileSystem(PosixFileSystemOptions options) : options_(std::move(options)) {}

  std::unique_ptr<File> create(const std::string& path) override {
    std::unique_ptr<File> file = open(path);
    struct stat status {};
    if (::fstat(file->descriptor(), &status) != 0) throw io_error(path, "look at", errno);
    // Emptying the file under this name would also empty it under its other name.
    if (status.st_nlink > 1) refuse_foreign(path, "has a second name (a hard link)");
    file->clear();
    return file;
  }

  std::unique_ptr<File> open(const std::string& path) override {
    for (;;) {
      // O_NONBLOCK: a pipe of this name must not wait for its other end.
      constexpr int kFlags = O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
      int descriptor = ::open(path.c_str(), kFlags | O_EXCL, 0666);
      const bool made = descriptor >= 0;
      if (!made && errno == EEXIST) descriptor = ::open(path.c_str(), kFlags, 0666);
      if (descriptor < 0) {
        const int reason = errno;
        // ELOOP may also come from a symbolic link among its directories.
        if (reason == ELOOP && is_link(path)) refuse_foreign(path, "is a symbolic link");
        throw not_created(path, "create", reason);
      }
      auto file = std::make_unique<PosixFile>(descriptor, path, made);
      if (lock(descriptor) == 0) {
        file->set_exclusive();
      } else if (errno == EWOULDBLOCK) {
        throw Error(
            ErrorKind::io,
            cat(path, ": is being written by another process or conversion; wait for it or choose another output"),
            SystemFailure{EWOULDBLOCK, path});
      } else {
        warn_once_unlockable(path, errno);
      }
      // Between open and lock, the previous writer may have renamed this very file to its result: writing to it would
      // then destroy that result.
      if (!file->has_its_name()) continue;
      struct stat mine {};
      if (::fstat(descriptor, &mine) != 0) throw io_error(path, "look at", errno);
      if (!S_ISREG(mine.st_mode)) refuse_foreign(path, "is no regular file");
      return file;
    }
  }

  std::unique_ptr<File> open_to_read(const std::string& path) override {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) throw io_error(path, "open for reading", errno);
    auto file = std::make_unique<PosixFile>(descriptor, path, false);
    struct stat status {};
    if (::fstat(descriptor, &status) != 0) throw io_error(path, "look at", errno);
    if (!S_ISREG(status.st_mode)) refuse_foreign(path, "is no regular file");
    return file;
  }

  std::unique_ptr<File> create_unnamed(const std::string& directory) override {
    int descriptor = ::open(directory.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
    if (descriptor < 0 && (errno == EOPNOTSUPP || errno == EISDIR)) {
      std::string name = directory + "/spillXXXXXX";
      descriptor = ::mkostemp(name.data(), O_CLOEXEC);
      if (descriptor >= 0) ::unlink(name.c_str());
    }
    if (descriptor < 0) throw not_created(directory, "create a temporary file in it", errno);
    return PosixFile::unnamed(descriptor, directory);
  }

  void rename(const std::string& from, const std::string& to) override {
    if (::rename(from.c_str(), to.c_str()) != 0) throw io_error(from, "rename to " + to, errno);
  }

  void rename_new(const std::string& from, const std::string& to) override {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return;
    if (errno != EINVAL && errno != ENOSYS) throw io_error(from, "rename to " + to, errno);
    // This file system cannot refuse to replace: look first.
    if (exists(to)) throw io_error(from, "rename to " + to, EEXIST);
    rename(from, to);
  }

  bool link(const std::string& from, const std::string& to) override {
    if (::link(from.c_str(), to.c_str()) == 0) return true;
    // EPERM also occurs for a file of another user, because the system may protect such files from links.
    if (errno == EPERM || errno == EOPNOTSUPP || errno == ENOSYS || errno == EMLINK) return false;
    throw io_error(from, "link to " + to, errno);
  }

  void remove(const std::string& path) override {
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) throw io_error(path, "remove", errno);
  }

  void make_directory(const std::string& path) override {
    if (::mkdir(path.c_str(), 0777) == 0) return;
    if (errno != EEXIST) throw not_created(path, "create the directory", errno);
    struct stat status {};
    if (::lstat(path.c_str(), &status) == 0 && !S_ISDIR(status.st_mode)) refuse_foreign(path, "is no directory");
  }

  void remove_directory(const std::string& path) override {
    if (::rmdir(path.c_str()) != 0 && errno != ENOENT) throw io_error(path, "remove the directory", errno);
  }

  void sync_directory(const std::string& path) override {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) throw io_error(path, "open the directory", errno);
    const int status = ::fsync(descriptor);
    const int reason = errno;
    ::close(descriptor);
    // Some network file systems cannot flush a directory and say EINVAL; their renames are durable by themselves.
    if (status != 0 && reason != EINVAL) throw io_error(path, "flush the directory", reason);
  }

  bool exists(const std::string& path) override {
    struct stat status {};
    return ::lstat(path.c_str(), &status) == 0;
  }

  bool is_replaceable(const std::string& path) override {
    struct stat status {};
    return ::stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode);
  }

  bool is_memory(const std::string& directory) override {
    struct statfs status {};
    if (::statfs(directory.c_str(), &status) != 0) throw io_error(directory, "look at the file system", errno);
    constexpr auto kTmpfs = 0x01021994;
    constexpr auto kRamfs = static_cast<decltype(status.f_type)>(0x858458f6);
    return status.f_type == kTmpfs || status.f_type == kRamfs;
  }

  std::uint64_t free_bytes(const std::string& directory) override {
    struct statvfs status {};
    if (::statvfs(directory.c_str(), &status) != 0) throw io_error(directory, "look at the free space", errno);
    return static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize;
  }

 private:
  int lock(int descriptor) const {
    return (options_.lock != nullptr ? options_.lock : ::flock)(descriptor, LOCK_EX | LOCK_NB);
  }

  void warn_once_unlockable(const std::string& path, int reason) {
    if (warned_.exchange(true) || !options_.notice) return;
    options_.notice(cat(path, ": cannot be locked: ", std::generic_category().message(reason),
                        "; see to it that no other process writes this output"));
  }

  PosixFileSystemOptions options_;
  std::atomic<bool> warned_{false};
};

}  // namespace

std::unique_ptr<File> FileSystem::open_to_read(const std::string& path) {
  if (!exists(path)) throw io_error(path, "open for reading", ENOENT);
  return open(path);
}

std::unique_ptr<FileSystem> make_posix_file_system(PosixFileSystemOptions options) {
  return std::make_unique<PosixFileSystem>(std::move(options));
}

}  // namespace weir
