#include "format/base/error.h"

#include <cerrno>
#include <system_error>
#include <utility>

namespace weir {

Error::Error(ErrorKind kind, Message message, std::optional<SystemFailure> failure) : kind_(kind) {
  std::string text = message.text();
  content_ = std::make_shared<const Content>(Content{std::move(message), std::move(text), std::move(failure)});
}

Message disk_full_remedy() {
  return compose("; free space on that file system or choose another with ", option("output"), " or ",
                 option("work-dir"));
}

Error usage_error(Message message) { return {ErrorKind::usage, std::move(message)}; }

Error input_error(const std::string& path, const Message& message) {
  return {ErrorKind::input, compose(path, ": ", message)};
}

const char* remedy_of(int errno_value) {
  switch (errno_value) {
    case ENOTDIR:
      return "; correct the path, a part of which is a file";
    case ELOOP:
      return "; correct the symbolic links of its path, which lead in a circle";
    case ENAMETOOLONG:
      return "; choose a shorter name";
    case EMFILE:
    case ENFILE:
      return "; raise the limit of open files (ulimit -n)";
    case EIO:
    case ESTALE:
      return "; check the disk or the file server";
    default:
      return "";
  }
}

Error io_error(const std::string& path, const Message& action, int errno_value) {
  Message remedy = remedy_of(errno_value);
  if (errno_value == ENOSPC || errno_value == EDQUOT) {
    remedy = disk_full_remedy();
  } else if (errno_value == EACCES || errno_value == EPERM || errno_value == EROFS) {
    remedy = "; check the permissions or choose another place";
  } else if (errno_value == EFBIG) {
    remedy = "; raise the limit of file size (ulimit -f) or choose another file system";
  }
  return {ErrorKind::io, compose(path, ": cannot ", action, ": ", std::generic_category().message(errno_value), remedy),
          SystemFailure{errno_value, path}};
}

std::string reason_of(const Error& error, const std::string& where) {
  const std::string text = error.what();
  const std::string begin = where + ": ";
  return text.starts_with(begin) ? text.substr(begin.size()) : text;
}

}  // namespace weir
