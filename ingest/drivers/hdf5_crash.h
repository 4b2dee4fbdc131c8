// What a program says when libhdf5 crashes at a damaged file, or comes to no end: some versions read beyond the memory
// of damaged metadata, or follow them in a circle.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace weir {

/// The line that report_hdf5_crashes() prints, with its end: `where` is the file, or file and dataset.
std::string hdf5_crash_line(const std::string& where);

/// Which thread reads values in the library, and the line to print of them: one at a time, under the library's lock.
struct Hdf5Reads {
  std::atomic<const std::string*> line{nullptr};
  std::atomic<int> thread{0};  ///< as gettid() counts; 0: none
};

/// Makes report_hdf5_crashes() look there, too: a driver has its own. `reads` must live as long as the program.
void watch_hdf5_reads(const Hdf5Reads& reads);

/// Gives the calling thread, for as long as it runs, a stack for handlers that want one of their own, as that of
/// report_hdf5_crashes() does: the thread's is used up where the library follows damaged metadata in a circle.
void keep_handler_stack();

/// While one exists, the thread that made it is in the library for the metadata of the file `path`. One at a time in a
/// thread.
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

/// While one exists, such a crash removes `paths`, files and empty directories, in their order: what a conversion has
/// begun. One at a time.
class Hdf5CrashRemoval {
 public:
  explicit Hdf5CrashRemoval(std::vector<std::string> paths);
  ~Hdf5CrashRemoval();
  Hdf5CrashRemoval(const Hdf5CrashRemoval&) = delete;
  Hdf5CrashRemoval& operator=(const Hdf5CrashRemoval&) = delete;

 private:
  std::vector<std::string> paths_;
};

/// For main() of a program that does one thing and ends: SIGSEGV, SIGBUS and SIGABRT of a thread within a Hdf5Call, or
/// that reads values as Hdf5Reads says, end it with a line of the file and exit code 3, since nothing that the library
/// holds can be trusted any more. Elsewhere they do what they did, as where something else handles them already, like a
/// sanitizer. A thread that computes for `longest` within one Hdf5Call, far longer than a whole file takes,
/// ends the program as well.
void report_hdf5_crashes(std::chrono::milliseconds longest = std::chrono::minutes(5));

}  // namespace weir
