#include "daemon/jobs/worker_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "format/process/page_size.h"

namespace weir {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

// The longest unfinished line that is kept. weir's own programs announce no longer lines, so a longer one is
// discarded.
constexpr std::size_t kMostLineBytes = 64 << 10;

struct Pipe {
  Descriptor read;
  Descriptor write;
};

Pipe make_pipe(const std::string& program) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw io_error(program, "make a pipe for it", errno);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// Everything the child needs. It is prepared before the fork, because only system calls are safe after it.
struct Launch {
  const char* program;
  std::vector<char*> arguments;
  pid_t daemon;
  int nice;
  IoClass io_class;
  int null;
  int log;
  int announce;
  int failure;  ///< receives errno if the program does not start
};

[[noreturn]] void run_child(const Launch& launch) {
  const auto give_up = [&] {
    const int reason = errno;
    [[maybe_unused]] const ssize_t told = ::write(launch.failure, &reason, sizeof reason);
    ::_exit(127);
  };
  ::setpgid(0, 0);
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) give_up();
  if (::getppid() != launch.daemon) ::_exit(127);  // the daemon died before the prctl() call
  // Ignored signals would stay ignored in the program and in all processes that it starts.
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGIO, SIGINT, SIGTERM, SIGCHLD}) ::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  // If a priority is refused, the work goes on; it only slows down others.
  if (launch.nice != 0) ::setpriority(PRIO_PROCESS, 0, launch.nice);
  if (launch.io_class != IoClass::none) {
    constexpr int kWhoProcess = 1;
    constexpr int kClassShift = 13;
    constexpr int kLowestBestEffort = (2 << kClassShift) | 7;
    constexpr int kIdle = 3 << kClassShift;
    ::syscall(SYS_ioprio_set, kWhoProcess, 0, launch.io_class == IoClass::idle ? kIdle : kLowestBestEffort);
  }
  // dup2 of a descriptor onto itself would leave close-on-exec set, so all descriptors are first moved to high
  // numbers.
  constexpr int kAside = 10;
  const int failure = ::fcntl(launch.failure, F_DUPFD_CLOEXEC, kAside);
  const int null = ::fcntl(launch.null, F_DUPFD_CLOEXEC, kAside);
  const int log = ::fcntl(launch.log, F_DUPFD_CLOEXEC, kAside);
  const int announce = ::fcntl(launch.announce, F_DUPFD_CLOEXEC, kAside);
  if (failure < 0 || null < 0 || log < 0 || announce < 0) give_up();
  if (::dup2(null, STDIN_FILENO) < 0 || ::dup2(log, STDOUT_FILENO) < 0 || ::dup2(log, STDERR_FILENO) < 0 ||
      ::dup2(announce, kAnnounceDescriptor) < 0) {
    give_up();
  }
  // Most of the daemon's descriptors are close-on-exec. This call covers the log file and descriptors that a library
  // opened without the flag; it needs Linux 5.11.
  ::syscall(SYS_close_range, kAnnounceDescriptor + 1, ~0U, 1U << 2U);  // CLOSE_RANGE_CLOEXEC
  ::execv(launch.program, launch.arguments.data());
  const int reason = errno;
  [[maybe_unused]] const ssize_t told = ::write(failure, &reason, sizeof reason);
  ::_exit(127);
}

}  // namespace

/// Lives until the child has ended and its pipes are read, or until the worker is destroyed and the child is reaped.
class WorkerProcess::Running : public std::enable_shared_from_this<Running> {
 public:
  Running(asio::io_context& io, Line line, Ended ended)
      : exit_(io),
        log_pipe_(io),
        announce_pipe_(io),
        kill_timer_(io),
        line_(std::move(line)),
        ended_(std::move(ended)) {}

  void start(const WorkerCommand& command) {
    const std::string& program = command.program;
    reap_wait_ = command.reap_wait;
    Pipe log = make_pipe(program);
    Pipe announce = make_pipe(program);
    Pipe failure = make_pipe(program);
    const Descriptor null(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    if (!null) throw io_error("/dev/null", "open", errno);
    std::vector<std::string> texts = command.arguments;
    Launch launch{program.c_str(),    {},         ::getpid(),      command.nice,
                  command.io_class,   null.get(), log.write.get(), announce.write.get(),
                  failure.write.get()};
    for (std::string& text : texts) launch.arguments.push_back(text.data());
    launch.arguments.push_back(nullptr);

    pid_ = ::fork();
    if (pid_ < 0) throw io_error(program, "start a process for it", errno);
    if (pid_ == 0) run_child(launch);
    failure.write.reset();
    int reason = 0;
    ssize_t told = 0;
    do {
      told = ::read(failure.read.get(), &reason, sizeof reason);
    } while (told < 0 && errno == EINTR);
    Descriptor exit(told == 0 ? static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)) : -1);
    if (!exit) {
      if (told == 0) reason = errno;
      kill_and_reap();
      pid_ = -1;
      throw io_error(program, "start it", reason);
    }
    error_code error = hand_over(exit, exit_);
    for (auto [pipe, end] : {std::pair(&log_pipe_, &log.read), std::pair(&announce_pipe_, &announce.read)}) {
      if (!error) error = hand_over(*end, *pipe);
      if (!error) pipe->non_blocking(true, error);
    }
    if (error) {
      abandon();
      if (pid_ > 0 && exit_.is_open()) await_end();  // finish() reaps the child when it ends
      throw Error(ErrorKind::io, cat(program, ": cannot watch its process: ", error.message(),
                                     "; raise fs.epoll.max_user_watches, or free memory"));
    }
    watch(log_pipe_, &Running::take_log);
    watch(announce_pipe_, &Running::take_announcement);
    await_end();
  }

  void stop(std::chrono::milliseconds grace) {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGTERM);
    kill_timer_.expires_after(grace);
    kill_timer_.async_wait([self = shared_from_this()](error_code error) {
      if (!error && self->pid_ > 0) self->kill_child();
    });
  }

  void abandon() {
    ended_ = nullptr;
    line_ = nullptr;
    if (kill_and_reap()) return close();
    close_pipes();  // finish() is called when the child has ended
  }

  pid_t pid() const { return pid_; }

 private:
  using Take = void (Running::*)(std::string_view);

  // If the system cannot watch the descriptor, `from` keeps it.
  static error_code hand_over(Descriptor& from, asio::posix::stream_descriptor& to) {
    error_code error;
    to.assign(from.get(), error);
    if (!error) from.release();
    return error;
  }

  void watch(asio::posix::stream_descriptor& pipe, Take take) {
    pipe.async_wait(asio::posix::stream_descriptor::wait_read,
                    [self = shared_from_this(), &pipe, take](error_code error) {
                      if (error || !pipe.is_open()) return;
                      if (self->read(pipe, take)) self->watch(pipe, take);
                    });
  }

  // Reads all bytes that are available now. Returns false at the pipe's end.
  bool read(asio::posix::stream_descriptor& pipe, Take take) {
    std::array<char, 4096> piece{};
    error_code error;
    while (const std::size_t bytes = pipe.read_some(asio::buffer(piece), error)) (this->*take)({piece.data(), bytes});
    return error == asio::error::would_block;
  }

  void take_log(std::string_view piece) {
    log_ += piece;
    if (log_.size() > 2 * kLogBytes) log_.erase(0, log_.size() - kLogBytes);
  }

  void take_announcement(std::string_view piece) {
    announced_ += piece;
    std::size_t begin = 0;
    for (std::size_t end; (end = announced_.find('\n', begin)) != std::string::npos; begin = end + 1) {
      if (line_) line_(std::string_view(announced_).substr(begin, end - begin));
    }
    announced_.erase(0, begin);
    if (announced_.size() > kMostLineBytes) announced_.clear();
  }

  void await_end() {
    exit_.async_wait(asio::posix::stream_descriptor::wait_read, [self = shared_from_this()](error_code error) {
      if (!error) self->finish();
    });
  }

  // Reaps the child. A wait may end although nothing happened: Asio's reactor reuses the state of a closed
  // descriptor, and an event of the old descriptor may still be in its queue. Therefore waitpid() must not block
  // here: that would stop the daemon.
  void finish() {
    if (pid_ <= 0) return;  // the worker was destroyed meanwhile
    int status = 0;
    pid_t reaped = 0;
    do {
      reaped = ::waitpid(pid_, &status, WNOHANG);
    } while (reaped < 0 && errno == EINTR);
    const int reason = errno;
    if (reaped == 0) return await_end();
    pid_ = -1;
    read(log_pipe_, &Running::take_log);
    read(announce_pipe_, &Running::take_announcement);
    close();
    WorkerEnd end;
    if (reaped < 0) {  // another thread has reaped the child, or SIGCHLD is ignored
      end.exit_code = static_cast<int>(ErrorKind::internal);
      log_ += cat("weir: how its process ended is not known (", std::generic_category().message(reason), ")\n");
    } else {
      end.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    }
    end.log = log_.size() > kLogBytes ? log_.substr(log_.size() - kLogBytes) : std::move(log_);
    line_ = nullptr;
    if (const Ended ended = std::exchange(ended_, nullptr)) ended(end);
  }

  void kill_child() {
    ::kill(pid_, SIGKILL);
    if (!killed_) killed_ = std::chrono::steady_clock::now();
  }

  // Kills the child and waits up to reap_wait_ for its end. Returns whether no child is left. The wait counts from
  // the first kill: otherwise the daemon would wait again for each of many children that hang.
  bool kill_and_reap() {
    if (pid_ <= 0) return true;
    kill_child();
    const auto end = *killed_ + reap_wait_;
    do {
      const pid_t reaped = ::waitpid(pid_, nullptr, WNOHANG);
      if (reaped == pid_ || (reaped < 0 && errno != EINTR)) {
        pid_ = -1;
        return true;
      }
      ::usleep(2000);
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }

  void close() {
    error_code ignored;
    exit_.close(ignored);
    close_pipes();
  }

  void close_pipes() {
    error_code ignored;
    log_pipe_.close(ignored);
    announce_pipe_.close(ignored);
    kill_timer_.cancel();
  }

  asio::posix::stream_descriptor exit_;  ///< a pidfd
  asio::posix::stream_descriptor log_pipe_;
  asio::posix::stream_descriptor announce_pipe_;
  asio::steady_timer kill_timer_;
  Line line_;
  Ended ended_;
  std::string log_;
  std::string announced_;  ///< the beginning of an unfinished line
  pid_t pid_ = -1;
  std::chrono::milliseconds reap_wait_{0};
  std::optional<std::chrono::steady_clock::time_point> killed_;  ///< when the child was first killed
};

WorkerProcess::WorkerProcess(asio::io_context& io, const WorkerCommand& command, Line line, Ended ended)
    : running_(std::make_shared<Running>(io, std::move(line), std::move(ended))) {
  running_->start(command);
}

WorkerProcess::~WorkerProcess() { running_->abandon(); }

void WorkerProcess::stop(std::chrono::milliseconds grace) { running_->stop(grace); }

std::uint64_t WorkerProcess::resident_bytes() const {
  std::ifstream statm(cat("/proc/", running_->pid(), "/statm"));
  std::uint64_t size = 0;
  std::uint64_t resident = 0;
  statm >> size >> resident;
  return resident * page_bytes();
}

std::uint64_t WorkerProcess::anonymous_bytes() const {
  std::ifstream status(cat("/proc/", running_->pid(), "/status"));
  for (std::string line; std::getline(status, line);) {
    std::istringstream fields(line);
    std::string name;
    std::uint64_t kib = 0;
    if (fields >> name >> kib && name == "RssAnon:") return kib << 10U;
  }
  return 0;
}

// Returns the part of /proc/PID/stat behind the name, which may hold any character.
std::string WorkerProcess::status_fields() const {
  std::ifstream file(cat("/proc/", running_->pid(), "/stat"));
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');
  return name_end == std::string::npos || name_end + 2 >= line.size() ? "" : line.substr(name_end + 2);
}

char WorkerProcess::process_state() const {
  const std::string fields = status_fields();
  return fields.empty() ? '\0' : fields.front();
}

std::uint64_t WorkerProcess::activity() const {
  constexpr int kTimesFrom = 11;  // user and system time, proc(5)
  std::istringstream fields(status_fields());
  std::string skipped;
  for (int i = 0; i < kTimesFrom; ++i) fields >> skipped;
  std::uint64_t user = 0;
  std::uint64_t system = 0;
  fields >> user >> system;
  std::uint64_t sum = user + system;
  std::ifstream io(cat("/proc/", running_->pid(), "/io"));
  for (std::string name; io >> name;) {
    std::uint64_t bytes = 0;
    io >> bytes;
    if (name == "rchar:" || name == "wchar:") sum += bytes;
  }
  return sum;
}

}  // namespace weir
