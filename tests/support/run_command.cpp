#include "tests/support/run_command.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <thread>

#include "tests/support/sanitized.h"

namespace weir {
namespace {

using std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPollInterval{2};

[[noreturn]] void fail(int error, const std::string& action) {
  throw std::system_error(error, std::generic_category(), action);
}

/// Makes a file in memory for the output. Unlike a pipe it never blocks the command, and it may be read at any time.
int make_sink(const char* name) {
  const int sink = memfd_create(name, MFD_CLOEXEC);
  if (sink < 0) fail(errno, "memfd_create");
  return sink;
}

std::string read_sink(int sink) {
  std::string text;
  char piece[4096];
  for (ssize_t n; (n = pread(sink, piece, sizeof piece, static_cast<off_t>(text.size()))) > 0;)
    text.append(piece, static_cast<std::size_t>(n));
  return text;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// Returns the test's own environment with the settings in `added` ("NAME=VALUE"). They replace settings of the same
/// name.
std::vector<std::string> environment_with(const std::vector<std::string>& added) {
  std::vector<std::string> result = added;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view setting = *entry;
    const std::string_view name_and_sign = setting.substr(0, setting.find('=') + 1);
    if (std::none_of(added.begin(), added.end(), [&](const std::string& a) { return a.starts_with(name_and_sign); }))
      result.emplace_back(setting);
  }
  return result;
}

/// The attributes and file actions of one posix_spawn.
struct SpawnSetup {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;

  SpawnSetup(int out, int err, const std::filesystem::path& directory) {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err, STDERR_FILENO);
    if (!directory.empty()) posix_spawn_file_actions_addchdir_np(&actions, directory.c_str());
    sigset_t none;
    sigset_t defaults;
    sigemptyset(&none);
    sigfillset(&defaults);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;
};

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& argv, CommandOptions options)
    : options_(std::move(options)), start_(steady_clock::now()), out_(make_sink("out")), err_(make_sink("err")) {
  std::vector<std::string> arguments = argv;
  std::vector<std::string> environment = environment_with(options_.environment);
  const SpawnSetup setup(out_, err_, options_.directory);
  const int error = posix_spawnp(&pid_, arguments.at(0).c_str(), &setup.actions, &setup.attributes,
                                 pointers(arguments).data(), pointers(environment).data());
  if (error != 0) {
    close(out_);
    close(err_);
    fail(error, "start " + arguments[0]);
  }
}

ChildProcess::~ChildProcess() {
  if (!ended_) {
    kill(-pid_, SIGKILL);
    reap(0);
  }
  close(out_);
  close(err_);
}

bool ChildProcess::reap(int wait_flags) {
  if (ended_) return true;
  int status = 0;
  rusage usage{};
  pid_t pid = 0;
  do pid = wait4(pid_, &status, wait_flags, &usage);
  while (pid < 0 && errno == EINTR);
  if (pid != pid_) return false;
  ended_.emplace();
  ended_->exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  ended_->peak_rss_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  return true;
}

bool ChildProcess::running() { return !reap(WNOHANG); }

void ChildProcess::send_signal(int signal) {
  if (running()) kill(pid_, signal);
}

CommandResult ChildProcess::wait() {
  bool timed_out = false;
  while (running()) {
    if (steady_clock::now() - start_ >= options_.timeout * (kSanitized ? 5 : 1)) {
      timed_out = true;
      kill(-pid_, SIGKILL);
      reap(0);
      break;
    }
    std::this_thread::sleep_for(kPollInterval);
  }
  CommandResult result = *ended_;
  result.timed_out = timed_out;
  result.out = out_so_far();
  result.err = err_so_far();
  return result;
}

std::string ChildProcess::out_so_far() const { return read_sink(out_); }
std::string ChildProcess::err_so_far() const { return read_sink(err_); }

CommandResult run_command(const std::vector<std::string>& argv, const CommandOptions& options) {
  return ChildProcess(argv, options).wait();
}

CommandResult run_weir(std::vector<std::string> arguments, const CommandOptions& options) {
  arguments.insert(arguments.begin(), WEIR_COMMAND);
  return run_command(arguments, options);
}

std::vector<std::string> list_directory(const std::filesystem::path& directory) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory))
    names.push_back(entry.path().lexically_relative(directory).string() + (entry.is_directory() ? "/" : ""));
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(errno, "open " + path.string());
  std::string content((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (in.bad()) fail(errno, "read " + path.string());
  return content;
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  if (!out.flush()) fail(errno, "write " + path.string());
}

}  // namespace weir
