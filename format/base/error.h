// The one error type of weir. A message is one line: what happened, where (path and offset, dataset or key), the value
// found, what to do. `main` prints it and exits with the kind's code; nothing else in the project ends the process. The
// front end that shows a message words its options: format/base/message.h.
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

/// The system's report of a call that failed.
struct SystemFailure {
  int errno_value = 0;
  std::string path;
};

class Error : public std::exception {
 public:
  Error(ErrorKind kind, Message message, std::optional<SystemFailure> failure = std::nullopt);

  ErrorKind kind() const noexcept { return kind_; }
  int exit_code() const noexcept { return static_cast<int>(kind_); }
  /// For a front end that has its own words for options.
  const Message& message() const noexcept { return content_->message; }
  /// For a front end with errors that carry a number and a file name; nullopt if no call of the system failed.
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

/// Returns the end of every message about a full disk.
Message disk_full_remedy();

/// Returns an Error of kind usage.
Error usage_error(Message message);

/// Returns an Error of kind input with the message "PATH: MESSAGE".
Error input_error(const std::string& path, const Message& message);

/// Returns "; what to do" if that follows from `errno_value` alone; otherwise empty.
const char* remedy_of(int errno_value);

/// Returns an Error of kind io with the message "PATH: cannot ACTION: strerror(ERRNO)" and what to do.
Error io_error(const std::string& path, const Message& action, int errno_value);

/// Returns the message of `error` in the command line's words, without a leading "WHERE: ", for lists that name the
/// place.
std::string reason_of(const Error& error, const std::string& where);

}  // namespace weir
