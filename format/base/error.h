// The one error type of weir. A message is one line: what, where (path and
// offset, dataset or key), the value found, what to do. `main` prints it and
// exits with the kind's code; nothing else in the project ends the process.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace weir {

/// What went wrong; the value is the command's exit code.
enum class ErrorKind {
  internal = 1,      ///< a fault of weir itself
  usage = 2,         ///< a wrong option or argument
  input = 3,         ///< bad or unreadable input
  budget = 4,        ///< the asked size cannot be met
  io = 5,            ///< disk full, permission, device failure
  interrupted = 130  ///< SIGINT or SIGTERM
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

  ErrorKind kind() const noexcept { return kind_; }
  int exit_code() const noexcept { return static_cast<int>(kind_); }

 private:
  ErrorKind kind_;
};

/// The end of every message of a full disk.
inline constexpr std::string_view kDiskFullRemedy =
    "; free space on that file system or choose another with -o or --work-dir";

/// Of kind usage.
Error usage_error(const std::string& message);

/// "PATH: MESSAGE", kind input.
Error input_error(const std::string& path, const std::string& message);

/// "PATH: ACTION: strerror(ERRNO)", kind io; ENOENT and ENOTDIR say the path is missing.
Error io_error(const std::string& path, const std::string& action, int errno_value);

}  // namespace weir
