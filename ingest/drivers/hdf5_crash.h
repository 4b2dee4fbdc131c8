// What a program reports when libhdf5 crashes on a damaged file or never returns. Some versions of the library read
// beyond the memory of damaged metadata, or follow them in a circle.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace weir {

/// Returns the line that report_hdf5_crashes() prints, with its line end. `where` names the file, or file and
/// dataset.
std::string hdf5_crash_line(const std::string& where);

/// The thread that reads values in the library, and the line to print if it crashes. Only one thread reads at a time,
/// under the library's lock.
struct Hdf5Reads {
  std::atomic<const std::string*> line{nullptr};
  std::atomic<int> thread{0};  ///< its gettid(); 0: none
};

/// Makes report_hdf5_crashes() use `reads` too, because a driver has its own. `reads` must live as long as the
/// program.
void watch_hdf5_reads(const Hdf5Reads& reads);

/// Gives the calling thread, until it ends, a separate stack for signal handlers that use one, as
/// report_hdf5_crashes() does. The thread's own stack is used up if the library follows damaged metadata in a circle.
void keep_handler_stack();

/// While an Hdf5Call exists, the thread that made it is in the library for the metadata of the file `path`. At most
/// one at a time in a thread.
class Hdf5Call {
 public:
  explicit Hdf5Call(const std::string& path);
  ~Hdf5Call();
  Hdf5Call(const Hdf5Call&) = delete;
  Hdf5Call& operator=(const Hdf5Call&) = delete;

 private:
  std::string line_;
  std::string stall_line_;
  std::optional<timer_t> timer_;
};

/// While an Hdf5CrashRemoval exists, a crash also removes `paths`, files and empty directories, in their order: the
/// unfinished output of a conversion. At most one at a time.
class Hdf5CrashRemoval {
 public:
  explicit Hdf5CrashRemoval(std::vector<std::string> paths);
  ~Hdf5CrashRemoval();
  Hdf5CrashRemoval(const Hdf5CrashRemoval&) = delete;
  Hdf5CrashRemoval& operator=(const Hdf5CrashRemoval&) = delete;

 private:
  std::vector<std::string> paths_;
};

/// For main() of a program that does one thing and ends. If a thread crashes (SIGSEGV, SIGBUS, SIGABRT) within an
/// Hdf5Call, or while it reads values as Hdf5Reads says, the program prints a line with the file and ends with exit
/// code 3: nothing that the library holds can be trusted any more. Elsewhere the signals keep their effect. A signal
/// that is handled already, for example by a sanitizer, is left alone. A thread that computes for `longest` within
/// one Hdf5Call, far longer than a whole file takes, ends the program as well.
void report_hdf5_crashes(std::chrono::milliseconds longest = std::chrono::minutes(5));

}  // namespace weir
