#include "daemon/jobs/worker_process.h"

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <thread>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/daemon/support/unkillable.h"
#include "tests/support/child_answer.h"
#include "tests/support/message_of_error.h"
#include "tests/support/run_command.h"

namespace weir::worker_process_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// Runs `script` in a shell as a worker until it has ended.
struct ShellRun {
  boost::asio::io_context io;
  std::vector<std::string> lines;
  std::optional<WorkerEnd> end;
  std::unique_ptr<WorkerProcess> worker;

  explicit ShellRun(const std::string& script, int nice = 0, milliseconds reap_wait = std::chrono::seconds(2)) {
    worker = std::make_unique<WorkerProcess>(
        io, WorkerCommand{"/bin/sh", {"sh", "-c", script}, nice, IoClass::none, reap_wait},
        [this](std::string_view line) { lines.emplace_back(line); },
        [this](const WorkerEnd& ended) {
          end = ended;
          worker.reset();  // destroying the worker is allowed here
        });
  }
  void run() { io.run(); }
};

std::size_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

TEST(WorkerProcess, GivesExitCodeLogAndAnnouncements) {
  ShellRun shell("echo out; echo err >&2; echo one >&3; printf 'tw' >&3; sleep 0.02; echo o >&3; exit 7");
  shell.run();
  ASSERT_TRUE(shell.end);
  EXPECT_EQ(shell.end->exit_code, 7);
  EXPECT_EQ(shell.end->log, "out\nerr\n");
  EXPECT_EQ(shell.lines, (std::vector<std::string>{"one", "two"}));
}

TEST(WorkerProcess, IgnoresNoSignalThatTheServiceIgnores) {
  for (const int signal : {SIGPIPE, SIGCHLD}) {
    const auto before = std::signal(signal, SIG_IGN);
    ShellRun shell(
        "sleep 0.1; while read -r key value; do [ $key != SigIgn: ] || echo $value >&3; done </proc/self/status");
    shell.run();
    std::signal(signal, before);
    ASSERT_EQ(shell.lines.size(), 1U);
    EXPECT_EQ(std::stoull(shell.lines[0], nullptr, 16) >> (signal - 1) & 1U, 0U) << shell.lines[0];
  }
}

// The system reaps the child, and nobody learns how it ended.
TEST(WorkerProcess, SigchldIgnored_WorkerCountsAsFailedWithTheReason) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  ShellRun shell("echo out; sleep 0.1; exit 3");
  shell.run();
  std::signal(SIGCHLD, before);
  ASSERT_TRUE(shell.end);
  EXPECT_EQ(shell.end->exit_code, static_cast<int>(ErrorKind::internal));
  EXPECT_EQ(shell.end->log, "out\nweir: how its process ended is not known (No child processes)\n");
}

TEST(WorkerProcess, KeepsTheEndOfALongLog) {
  ShellRun shell("i=0; while [ $i -lt 5000 ]; do echo line $i; i=$((i+1)); done");
  shell.run();
  EXPECT_EQ(shell.end->log.size(), WorkerProcess::kLogBytes);
  EXPECT_TRUE(shell.end->log.ends_with("line 4998\nline 4999\n"));
}

TEST(WorkerProcess, ReadsAllThatWasAnnouncedBeforeTheEnd) {
  ShellRun shell("i=0; while [ $i -lt 3000 ]; do echo $i >&3; i=$((i+1)); done");
  shell.run();
  ASSERT_EQ(shell.lines.size(), 3000U);
  EXPECT_EQ(shell.lines.back(), "2999");
}

TEST(WorkerProcess, KilledBySignal_ExitCodeIs128PlusTheSignal) {
  ShellRun shell("kill -SEGV $$");
  shell.run();
  EXPECT_EQ(shell.end->exit_code, 128 + SIGSEGV);
}

// Asio's reactor reuses the state of a closed descriptor for the next descriptor, which then receives a pending event
// of the old one. Such an event must not make the daemon wait for the child.
TEST(WorkerProcess, EventOfADescriptorThatWasClosed_IsNotTakenForTheEnd) {
  boost::asio::io_context io;
  using Socket = boost::asio::local::stream_protocol::socket;
  Socket first(io);
  Socket first_peer(io);
  Socket second(io);
  Socket second_peer(io);
  boost::asio::local::connect_pair(first, first_peer);
  boost::asio::local::connect_pair(second, second_peer);
  std::unique_ptr<WorkerProcess> worker;
  std::optional<WorkerEnd> end;
  bool told = false;
  // Both sockets have an event in the queue when the handler of one closes the other.
  const auto start = [&](Socket& other) {
    if (worker) return;
    other.close();
    worker = std::make_unique<WorkerProcess>(
        io,
        WorkerCommand{"/bin/sh",
                      {"sh", "-c", "trap 'exit 3' TERM; echo ready >&3; while :; do sleep 0.01; done"},
                      0,
                      IoClass::none},
        [&](std::string_view) {
          told = true;
          worker->stop(milliseconds(5000));
        },
        [&](const WorkerEnd& ended) { end = ended; });
  };
  first.async_wait(Socket::wait_read, [&](const boost::system::error_code& error) {
    if (!error) start(second);
  });
  second.async_wait(Socket::wait_read, [&](const boost::system::error_code& error) {
    if (!error) start(first);
  });
  io.poll();
  first_peer.write_some(boost::asio::buffer("x", 1));
  second_peer.write_some(boost::asio::buffer("x", 1));
  io.run();  // would never return if the child were waited for
  EXPECT_TRUE(told);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->exit_code, 3);
}

TEST(WorkerProcess, StopSendsSigtermFirst) {
  ShellRun shell("trap 'echo asked; exit 3' TERM; echo ready >&3; while :; do sleep 0.01; done");
  while (shell.lines.empty()) shell.io.run_one();
  shell.worker->stop(milliseconds(5000));
  shell.run();
  EXPECT_EQ(shell.end->exit_code, 3);
  EXPECT_EQ(shell.end->log, "asked\n");
}

TEST(WorkerProcess, Stop_SigtermIgnored_KillsAfterTheGrace) {
  ShellRun shell("trap '' TERM; echo ready >&3; while :; do sleep 0.01; done");
  while (shell.lines.empty()) shell.io.run_one();
  const auto begin = steady_clock::now();
  shell.worker->stop(milliseconds(100));
  shell.run();
  EXPECT_EQ(shell.end->exit_code, 128 + SIGKILL);
  EXPECT_GE(steady_clock::now() - begin, milliseconds(100));
}

TEST(WorkerProcess, DestructionKillsTheProcessWithoutACallback) {
  ShellRun shell("trap '' TERM; echo $$ >&3; while :; do sleep 0.01; done");
  while (shell.lines.empty()) shell.io.run_one();
  const auto pid = static_cast<pid_t>(std::stoi(shell.lines.front()));
  shell.worker.reset();
  EXPECT_EQ(::kill(pid, 0), -1) << "neither running nor a zombie";
  shell.run();
  EXPECT_FALSE(shell.end);
}

TEST(WorkerProcess, KilledProcessThatEndsLater_IsReapedThen) {
  const std::size_t before = open_descriptors();
  {
    ShellRun shell("echo $$ >&3; exec sleep 60", 0, milliseconds(0));
    while (shell.lines.empty()) shell.io.run_one();
    const auto pid = static_cast<pid_t>(std::stoi(shell.lines.front()));
    shell.worker.reset();
    shell.run();
    EXPECT_EQ(::kill(pid, 0), -1) << "neither running nor a zombie";
    EXPECT_FALSE(shell.end);
  }
  EXPECT_EQ(open_descriptors(), before);
}

// Otherwise each of many hanging processes would make the service wait.
TEST(WorkerProcess, KilledProcessThatDoesNotEnd_IsWaitedForOnce) {
  if (!Unkillable::possible()) GTEST_SKIP() << "only root may have processes that it cannot kill";
  ShellRun shell("echo $$ >&3; exec sleep 600", 0, milliseconds(1000));
  while (shell.lines.empty()) shell.io.run_one();
  const pid_t pid = std::stoi(shell.lines[0]);
  {
    const Unkillable unkillable;
    shell.worker->stop(milliseconds(0));
    shell.io.run_for(milliseconds(1100));
    const auto begin = steady_clock::now();
    shell.worker.reset();
    EXPECT_LT(steady_clock::now() - begin, milliseconds(500));
  }
  EXPECT_FALSE(shell.end);
  ::kill(pid, SIGKILL);
  EXPECT_EQ(::waitpid(pid, nullptr, 0), pid);
}

TEST(WorkerProcess, RunsInItsOwnGroupWithItsPriorityAndNoInheritedDescriptors) {
  const int leaked = ::dup(0);  // not close-on-exec
  ShellRun shell("ps -o pgid=,ni= -p $$; echo $$; ls /proc/self/fd | wc -l", 5);
  shell.run();
  ::close(leaked);
  std::istringstream words(shell.end->log);
  int group = 0;
  int nice = 0;
  int pid = 0;
  int descriptors = 0;
  words >> group >> nice >> pid >> descriptors;
  EXPECT_EQ(group, pid);
  EXPECT_EQ(nice, 5);
  EXPECT_EQ(descriptors, 5) << "the three, the announcements, and the directory that ls lists";
}

TEST(WorkerProcess, LeaksNoDescriptors) {
  const std::size_t before = open_descriptors();
  {
    ShellRun shell("true");
    shell.run();
  }
  EXPECT_EQ(open_descriptors(), before);
}

TEST(WorkerProcess, SaysWhyAProgramDoesNotStart) {
  boost::asio::io_context io;
  std::vector<std::size_t> open;
  for (int attempt = 0; attempt < 3; ++attempt) {
    try {
      const WorkerProcess worker(io, {"/nowhere/weir", {"weir", "convert"}, 0, IoClass::none}, {}, {});
      FAIL() << "started";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io);
      EXPECT_STREQ(error.what(), io_error("/nowhere/weir", "start it", ENOENT).what());
    }
    open.push_back(open_descriptors());
  }
  EXPECT_EQ(open[1], open[0]);
  EXPECT_EQ(open[2], open[0]);
}

// From here on this process and its children cannot add to epoll, as at the limit fs.epoll.max_user_watches.
bool refuse_epoll() {
  std::array<sock_filter, 4> steps{{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                                    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_epoll_ctl, 0, 1),
                                    BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSPC),
                                    BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)}};
  const sock_fprog filter{static_cast<unsigned short>(steps.size()), steps.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

TEST(WorkerProcess, ProcessThatCannotBeWatched_IsAnIoErrorAndReaped) {
  const std::string answer = answer_of_child([] {
    boost::asio::io_context io;
    const boost::asio::posix::stream_descriptor before(io);  // creates Asio's own epoll descriptor
    const std::size_t open = open_descriptors();
    if (!refuse_epoll()) return std::string("no seccomp");
    const std::string message = message_of_error(ErrorKind::io, [&] {
      const WorkerProcess worker(io, {"/bin/sh", {"sh", "-c", "sleep 60"}, 0, IoClass::none}, {}, {});
    });
    if (::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD) return std::string("a child is left");
    return open_descriptors() == open ? message : std::string("a descriptor is left");
  });
  if (answer == "no seccomp") GTEST_SKIP() << answer;
  EXPECT_EQ(
      answer,
      "/bin/sh: cannot watch its process: No space left on device; raise fs.epoll.max_user_watches, or free memory");
}

TEST(WorkerProcess, DiesWithTheDaemon) {
  // A process starts a worker and is killed; the worker's process must end, too.
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t daemon = ::fork();
  if (daemon == 0) {
    boost::asio::io_context io;
    WorkerProcess worker(io, {"/bin/sh", {"sh", "-c", "echo $$ >&3; exec sleep 60"}, 0, IoClass::none},
                         [&](std::string_view line) {
                           const auto pid = static_cast<pid_t>(std::stoi(std::string(line)));
                           [[maybe_unused]] const auto told = ::write(ends[1], &pid, sizeof pid);
                         },
                         {});
    io.run();
    ::_exit(0);
  }
  pid_t worker = 0;
  ASSERT_EQ(::read(ends[0], &worker, sizeof worker), static_cast<ssize_t>(sizeof worker));
  ::kill(daemon, SIGKILL);
  ::waitpid(daemon, nullptr, 0);
  const auto gone = [&] {
    const std::string state = run_command({"ps", "-o", "state=", "-p", cat(worker)}).out;
    return state.empty() || state.front() == 'Z';  // there may be no parent that reaps it
  };
  const auto deadline = steady_clock::now() + std::chrono::seconds(5);
  while (!gone() && steady_clock::now() < deadline) std::this_thread::sleep_for(milliseconds(5));
  EXPECT_TRUE(gone());
  ::close(ends[0]);
  ::close(ends[1]);
}

}  // namespace
}  // namespace weir::worker_process_test
