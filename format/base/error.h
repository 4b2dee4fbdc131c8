// The one error type of weir. A message is one line: what, where (path and
// offset, dataset or key), the value found, what to do. `main` prints it and
// exits with the kind's code; nothing else in the project ends the process.
// Options in it are worded by whoever shows it: format/base/message.h.
#pragma once

#include <exception>
#include <memory>
#include <string>

#include "format/base/message.h"

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

class Error : public std::exception {
 public:
  Error(ErrorKind kind, Message message);

  ErrorKind kind() const noexcept { return kind_; }
  int exit_code() const noexcept { return static_cast<int>(kind_); }
  /// For a front end with words of its own for options.
  const Message& message() const noexcept { return content_->message; }
  /// The message in the command line's words.
  const char* what() const noexcept override { return content_->text.c_str(); }

 private:
  struct Content {
    Message message;
    std::string text;
  };
  ErrorKind kind_;
  std::shared_ptr<const Content> content_;  // shared: copying an exception must not throw
};

/// The end of every message of a full disk.
Message disk_full_remedy();

/// Of kind usage.
Error usage_error(Message message);

/// "PATH: MESSAGE", kind input.
Error input_error(const std::string& path, const Message& message);

/// "PATH: ACTION: strerror(ERRNO)", kind io; ENOENT and ENOTDIR say the path is missing.
Error io_error(const std::string& path, const Message& action, int errno_value);

}  // namespace weir
