#include "daemon/config/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "format/io/refused_open.h"

namespace weir {
namespace {

Error no_regular_file(const std::string& path) {
  return input_error(path, "is no regular file, and weir watch reads it again at each reload; name a file");
}

}  // namespace

void require_regular_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) throw no_regular_file(path);
}

std::string read_regular_file(const std::string& path, std::uint64_t most_bytes) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (!file || ::fstat(file.get(), &status) != 0) throw refused_open(path, "read", errno);
  if (S_ISDIR(status.st_mode)) throw refused_open(path, "read", EISDIR);
  if (!S_ISREG(status.st_mode)) throw no_regular_file(path);
  std::string text;
  std::array<char, 4096> piece{};
  while (true) {
    const ssize_t count = ::read(file.get(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw refused_open(path, "read", errno);
    if (count == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(count));
    if (text.size() > most_bytes) {
      throw input_error(path, cat("has more than ", most_bytes, " bytes, no such file needs as many; name another"));
    }
  }
}

}  // namespace weir
