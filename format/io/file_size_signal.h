// The signal of a file that grows beyond the limit of file size, SIGXFSZ, whose default ends the process. A library
// must neither let it end its host nor change what the host does at signals.
#pragma once

#include <csignal>

namespace weir {

/// While it lives, calls of this thread that make a file larger than the limit (ulimit -f) fail with EFBIG and send no
/// signal. A signal that came for another reason is kept. Without a limit it does nothing.
class NoFileSizeSignal {
 public:
  NoFileSizeSignal();
  /// Keeps errno.
  ~NoFileSizeSignal();
  NoFileSizeSignal(const NoFileSizeSignal&) = delete;
  NoFileSizeSignal& operator=(const NoFileSizeSignal&) = delete;

 private:
  bool limited_ = false;
  bool pending_ = false;  // before
  sigset_t former_{};
};

}  // namespace weir
