// The one error type of weir. A message is one line: what, where (path and
// offset, dataset or key), the value found, what to do. `main` prints it and
// exits with the kind's code; nothing else in the project ends the process.
// Options in it are worded by whoever shows it: format/base/message.h.
#pragma once

#include <exception>
#include <memory>
#include <optional>
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

/// What the system said of a call that failed.
struct SystemFailure {
  int errno_value = 0;
  std::string path;
};

class Error : public std::exception {
 public:
  Error(ErrorKind kind, Message message, std::optional<SystemFailure> failure = std::nullopt);

  ErrorKind kind() const noexcept { return kind_; }
  int exit_code() const noexcept { return static_cast<int>(kind_); }
  /// For a front end with words of its own for options.
  const Message& message() const noexcept { return content_->message; }
  /// For a front end whose errors have a number and a file's name; nullopt where no call of the system failed.
  const std::optional<SystemFailure>& system_failure() const noexcept { return content_->failure; }
  /// The message in the command line's words.
  const char* what() const noexcept override { return content_->text.c_str(); }

 private:
  struct Content {
    Message message;
    std::string text;
    std::optional<SystemFailure> failure;
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

/// "; what to do", where that follows from what the system said alone; else empty.
const char* remedy_of(int errno_value);

/// "PATH: cannot ACTION: strerror(ERRNO)" and what to do, kind io.
Error io_error(const std::string& path, const Message& action, int errno_value);

/// What `error` says in the command line's words, without "WHERE: " where it begins so: for a list that says where.
std::string reason_of(const Error& error, const std::string& where);

/// The exception that is being handled; one of another type is of kind internal.
Error error_in_flight();

}  // namespace weir
