#include "format/io/file_size_signal.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>

#include "format/io/descriptor.h"
#include "format/io/file_system.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir::file_size_signal_test {
namespace {

constexpr rlim_t kLimit = 4096;

/// A limit of file size, and the default action at its signal: the process would end.
class FileSizeSignal : public ::testing::Test {
 protected:
  FileSizeSignal() {
    ::getrlimit(RLIMIT_FSIZE, &former_);
    rlimit limit = former_;
    limit.rlim_cur = kLimit;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_DFL);
  }
  ~FileSizeSignal() override {
    ::setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, SIG_DFL);
  }

  /// Writes beyond the limit; returns errno.
  int write_too_far() const {
    const Descriptor file(::open((directory_ / "a").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
    const NoFileSizeSignal no_signal;
    return ::pwrite(file.get(), "x", 1, kLimit) < 0 ? errno : 0;
  }
  static bool is_pending() {
    sigset_t pending;
    ::sigpending(&pending);
    return sigismember(&pending, SIGXFSZ) == 1;
  }
  static bool is_blocked() {
    sigset_t blocked;
    ::pthread_sigmask(SIG_BLOCK, nullptr, &blocked);
    return sigismember(&blocked, SIGXFSZ) == 1;
  }
  static void set_blocked(bool blocked) {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGXFSZ);
    ::pthread_sigmask(blocked ? SIG_BLOCK : SIG_UNBLOCK, &set, nullptr);
  }

  TemporaryDirectory directory_;
  rlimit former_{};
};

TEST_F(FileSizeSignal, WriteBeyondTheLimit_FailsAndSendsNone) {
  EXPECT_EQ(write_too_far(), EFBIG);
  EXPECT_FALSE(is_pending());
  EXPECT_FALSE(is_blocked());
}

TEST_F(FileSizeSignal, OfAProgramThatBlocksOrIgnoresIt_ChangesNothing) {
  set_blocked(true);
  EXPECT_EQ(write_too_far(), EFBIG);
  EXPECT_FALSE(is_pending());
  EXPECT_TRUE(is_blocked());
  set_blocked(false);
  std::signal(SIGXFSZ, SIG_IGN);
  EXPECT_EQ(write_too_far(), EFBIG);
  EXPECT_FALSE(is_pending());
  EXPECT_EQ(std::signal(SIGXFSZ, SIG_DFL), SIG_IGN);
}

TEST_F(FileSizeSignal, OneThatWasPending_IsKept) {
  set_blocked(true);
  ::pthread_kill(::pthread_self(), SIGXFSZ);
  EXPECT_EQ(write_too_far(), EFBIG);
  EXPECT_TRUE(is_pending());
  std::signal(SIGXFSZ, SIG_IGN);  // also discards it
  set_blocked(false);
}

TEST_F(FileSizeSignal, FilesOfTheDisk_SendNone) {
  const auto files = make_posix_file_system();
  const auto file = files->create(directory_ / "b");
  const std::string message = "; raise the limit of file size (ulimit -f) or choose another file system";
  const std::array<std::byte, 2 * kLimit> bytes{};
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { file->write_at(0, bytes); }),
            (directory_ / "b") + ": cannot write 4096 bytes at offset 4096: File too large" + message);
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { file->preallocate(2 * kLimit); }),
            (directory_ / "b") + ": cannot reserve 8192 bytes: File too large" + message);
  EXPECT_FALSE(is_pending());
}

}  // namespace
}  // namespace weir::file_size_signal_test
