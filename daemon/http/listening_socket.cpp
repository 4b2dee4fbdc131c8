#include "daemon/http/listening_socket.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <cerrno>
#include <cstring>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;
using UnixProtocol = boost::asio::local::stream_protocol;

constexpr mode_t kOwnerAndGroup = 0660;

tcp::endpoint endpoint_of(const ListenAddress& address) {
  error_code error;
  const auto ip = boost::asio::ip::make_address(address.host == "localhost" ? "127.0.0.1" : address.host, error);
  if (error) {
    throw Error(ErrorKind::usage,
                cat(address.text(), ": cannot listen on a name; write this machine's address, or 0.0.0.0 for all"));
  }
  return {ip, address.port};
}

// Conversions are child processes: they inherit none of the server's sockets.
template <typename Socket>
void close_on_exec(Socket& socket) {
  ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
}

// A socket for both kinds of address gives 127.0.0.1 as ::ffff:127.0.0.1.
bool is_this_machine(const boost::asio::ip::address& address) {
  using namespace boost::asio::ip;
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    return make_address_v4(v4_mapped, address.to_v6()).is_loopback();
  return address.is_loopback();
}

// Refuses a path at which there is something else than a socket that nobody listens on any more.
void require_free(boost::asio::io_context& io, const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return;  // what else is wrong, bind says
  if (!S_ISSOCK(status.st_mode)) {
    throw Error(ErrorKind::io, cat(path, ": cannot listen: there is a file that is no socket; name another path"));
  }
  UnixProtocol::socket probe(io);
  error_code error;
  probe.connect(UnixProtocol::endpoint(path), error);
  if (!error) {
    throw Error(ErrorKind::io, cat(path,
                                   ": cannot listen: another process does; is another weir watch running? choose "
                                   "another service.control_socket"));
  }
}

}  // namespace

ListeningSocket::ListeningSocket(boost::asio::io_context& io, const ListenAddress& address) : acceptor_(io) {
  if (address.is_unix()) {
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
  if (error) {
    throw Error(ErrorKind::io, cat(address.text(), ": cannot listen: ", error.message(),
                                   "; is another weir watch running? choose another service.listen"));
  }
}

// 1. The socket is bound beside its path, so that nobody connects before 2.
// 2. It gets its mode, listens,
// 3. and is renamed to its path, in place of what a killed process left there.
void ListeningSocket::listen_on_path(const std::string& path) {
  const std::string beside = cat(path.substr(0, path.rfind('/') + 1), ".weir-", ::getpid());
  const auto fail = [&](const char* what, int cause) {
    ::unlink(beside.c_str());
    throw io_error(path, what, cause);
  };
  for (const std::string* name : {&beside, &path}) {
    if (name->size() > kLongestSocketPath) {
      throw Error(ErrorKind::usage, cat(path, ": cannot listen: a socket's path has ", kLongestSocketPath,
                                        " bytes at most; choose a shorter service.control_socket"));
    }
  }
  ::unlink(beside.c_str());
  error_code error;
  acceptor_.open(UnixProtocol(), error);
  if (error) fail("listen", error.value());
  close_on_exec(acceptor_);
  acceptor_.bind(UnixProtocol::endpoint(beside), error);
  if (error) fail("listen", error.value());
  if (::chmod(beside.c_str(), kOwnerAndGroup) != 0) fail("set the mode", errno);
  acceptor_.listen(Acceptor::max_listen_connections, error);
  if (error) fail("listen", error.value());
  struct stat status {};
  if (::lstat(beside.c_str(), &status) != 0 || ::rename(beside.c_str(), path.c_str()) != 0) fail("listen", errno);
  path_ = path;
  device_ = status.st_dev;
  inode_ = status.st_ino;
}

std::uint16_t ListeningSocket::port() const {
  if (!path_.empty()) return 0;
  tcp::endpoint endpoint;
  const auto generic = acceptor_.local_endpoint();
  endpoint.resize(generic.size());
  std::memcpy(endpoint.data(), generic.data(), generic.size());
  return endpoint.port();
}

void ListeningSocket::close() {
  error_code ignored;
  acceptor_.close(ignored);
  struct stat status {};
  const bool ours =
      !path_.empty() && ::lstat(path_.c_str(), &status) == 0 && status.st_dev == device_ && status.st_ino == inode_;
  if (ours) ::unlink(path_.c_str());
  path_.clear();
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
