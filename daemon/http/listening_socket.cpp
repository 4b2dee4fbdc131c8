#include "daemon/http/listening_socket.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
using UnixProtocol = boost::asio::local::stream_protocol;

constexpr mode_t kOwnerAndGroup = 0660;
constexpr std::string_view kBeside = ".new";

tcp::endpoint endpoint_of(const ListenAddress& address) {
  error_code error;
  const auto ip = boost::asio::ip::make_address(address.host == "localhost" ? "127.0.0.1" : address.host, error);
  if (error) {
    throw Error(ErrorKind::usage,
                cat(address.text(), ": cannot listen on a name; write this machine's address, or 0.0.0.0 for all"));
  }
  return {ip, address.port};
}

// Conversions are child processes, which must not inherit the server's sockets.
template <typename Socket>
void close_on_exec(Socket& socket) {
  ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
}

// A socket for both IP versions reports 127.0.0.1 as ::ffff:127.0.0.1.
bool is_this_machine(const boost::asio::ip::address& address) {
  using namespace boost::asio::ip;
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    return make_address_v4(v4_mapped, address.to_v6()).is_loopback();
  return address.is_loopback();
}

[[noreturn]] void refuse_used(const std::string& path) {
  throw Error(ErrorKind::io, cat(path,
                                 ": cannot listen: another process does; is another weir watch running? choose "
                                 "another service.control_socket"));
}

// Takes the lock of `path`. A process holds it while it listens at the path or prepares to.
Descriptor lock_path(const std::string& path) {
  const std::string lock = path + ".lock";
  Descriptor file(::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (file.get() < 0 && errno == ENOENT) {
    throw Error(ErrorKind::io, cat(path,
                                   ": cannot listen: there is no such directory; make it, or choose another "
                                   "service.control_socket"));
  }
  if (file.get() < 0) throw io_error(lock, "open", errno);
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) refuse_used(path);
    throw io_error(lock, "lock", errno);
  }
  return file;
}

bool is_socket(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISSOCK(status.st_mode);
}

// Throws if there is something at the path other than a socket without a listener. The lock does not show this,
// because other programs take no lock.
void require_free(boost::asio::io_context& io, const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return;  // bind reports any other fault
  if (!S_ISSOCK(status.st_mode)) {
    throw Error(ErrorKind::io, cat(path, ": cannot listen: there is a file that is no socket; name another path"));
  }
  UnixProtocol::socket probe(io);
  error_code error;
  probe.open(UnixProtocol(), error);
  if (!error) probe.non_blocking(true, error);
  if (!error) probe.connect(UnixProtocol::endpoint(path), error);
  if (error == boost::asio::error::connection_refused) return;
  if (!error || error == boost::asio::error::would_block || error == boost::asio::error::in_progress) refuse_used(path);
  throw io_error(path, "see whether another process listens there", error.value());
}

}  // namespace

ListeningSocket::ListeningSocket(boost::asio::io_context& io, const ListenAddress& address) : acceptor_(io) {
  if (address.is_unix()) {
    if (address.path.size() > kLongestSocketPath) {
      throw Error(ErrorKind::usage, cat(address.path, ": cannot listen: a socket's path has ", kLongestSocketPath,
                                        " bytes at most; choose a shorter service.control_socket"));
    }
    lock_ = lock_path(address.path);
    require_free(io, address.path);
    listen_on_path(address.path);
  } else {
    listen_on_tcp(address);
  }
}

void ListeningSocket::listen_on_tcp(const ListenAddress& address) {
  const tcp::endpoint endpoint = endpoint_of(address);
  error_code error;
  acceptor_.open(endpoint.protocol(), error);
  if (!error) {
    close_on_exec(acceptor_);
    acceptor_.set_option(Acceptor::reuse_address(true), error);
  }
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(Acceptor::max_listen_connections, error);
  if (error == boost::asio::error::address_in_use) {
    throw Error(ErrorKind::io, cat(address.text(),
                                   ": cannot listen: another process does, another weir watch or weir view perhaps; "
                                   "listen on an address of its own, as ",
                                   ListenAddress{address.host, static_cast<std::uint16_t>(address.port ^ 1U)}.text()));
  }
  if (error) {
    throw Error(ErrorKind::io,
                cat(address.text(), ": cannot listen: ", error.message(), "; listen on another address"));
  }
}

// 1. The socket is bound under another name beside its path, so that nobody connects before step 3.
// 2. It gets its mode and listens.
// 3. It is renamed to its path and replaces what a killed process left there.
void ListeningSocket::listen_on_path(const std::string& path) {
  const std::string beside = cat(path, kBeside);
  const auto fail = [&](const char* what, int cause) {
    ::unlink(beside.c_str());
    throw io_error(path, what, cause);
  };
  if (is_socket(beside)) ::unlink(beside.c_str());  // left by a process that was killed before step 3
  error_code error;
  acceptor_.open(UnixProtocol(), error);
  if (!error) close_on_exec(acceptor_);
  if (!error) acceptor_.bind(UnixProtocol::endpoint(beside), error);
  if (error) throw io_error(beside, "listen", error.value());
  if (::chmod(beside.c_str(), kOwnerAndGroup) != 0) fail("set the mode", errno);
  acceptor_.listen(Acceptor::max_listen_connections, error);
  if (error) fail("listen", error.value());
  if (::rename(beside.c_str(), path.c_str()) != 0) fail("listen", errno);
  path_ = path;
}

std::uint16_t ListeningSocket::port() const {
  if (!path_.empty()) return 0;
  tcp::endpoint endpoint;
  const auto generic = acceptor_.local_endpoint();
  endpoint.resize(generic.size());
  std::memcpy(endpoint.data(), generic.data(), generic.size());
  return endpoint.port();
}

// Removes the path before it releases the lock: afterwards the path may belong to another process.
void ListeningSocket::close() {
  error_code ignored;
  acceptor_.close(ignored);
  if (!path_.empty()) ::unlink(path_.c_str());
  path_.clear();
  lock_.reset();
}

bool prepare(StreamSocket& socket) {
  close_on_exec(socket);
  error_code error;
  const auto generic = socket.remote_endpoint(error);
  if (generic.protocol().family() == AF_UNIX) return true;
  socket.set_option(tcp::no_delay(true), error);
  tcp::endpoint endpoint;
  if (generic.size() > endpoint.capacity()) return false;
  endpoint.resize(generic.size());
  std::memcpy(endpoint.data(), generic.data(), generic.size());
  return is_this_machine(endpoint.address());
}

}  // namespace weir
