// What a program says when libhdf5 crashes at a damaged file: some versions read beyond the memory of damaged metadata.
#pragma once

#include <string>

namespace weir {

/// While one exists, the thread that made it is in the library for the file `path`. One at a time in a thread.
class Hdf5Call {
 public:
  explicit Hdf5Call(const std::string& path);
  ~Hdf5Call();
  Hdf5Call(const Hdf5Call&) = delete;
  Hdf5Call& operator=(const Hdf5Call&) = delete;

 private:
  std::string message_;
};

/// For main() of a program that does one thing and ends: SIGSEGV, SIGBUS and SIGABRT of a thread within a Hdf5Call end
/// it with a line of the file and exit code 3, since nothing that the library holds can be trusted any more. Elsewhere
/// they do what they did, as where something else handles them already, like a sanitizer.
void report_hdf5_crashes();

}  // namespace weir
