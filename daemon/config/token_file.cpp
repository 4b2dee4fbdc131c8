#include "daemon/config/token_file.h"

#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>

#include "daemon/config/regular_file.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/refused_open.h"

namespace weir {
namespace {

constexpr std::uint64_t kMostTokenBytes = 4096;

}  // namespace

std::string read_token_file(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) throw refused_open(path, "read the token", errno);
  if (S_ISDIR(status.st_mode)) throw input_error(path, "is a directory; name a file with the token");
  if ((status.st_mode & S_IROTH) != 0) throw input_error(path, "can be read by everybody; chmod o-r it");
  const std::string text = read_regular_file(path, kMostTokenBytes);
  return text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
}

std::string token_fault(std::string_view token) {
  if (token.empty()) return "the token is empty; openssl rand -hex 32 makes one";
  const bool fits_a_header = std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c <= '~'; });
  return fits_a_header ? "" : "the token must be ASCII without spaces; openssl rand -hex 32 makes one";
}

std::string make_token() {
  std::array<unsigned char, 32> random{};
  if (::getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
    throw io_error("a token", "get random bytes for it", errno);
  }
  std::string token;
  for (const unsigned char byte : random) token += hex(byte, 2);
  return token;
}

}  // namespace weir
