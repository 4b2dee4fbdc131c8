#include "daemon/log/notify.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "tests/support/run_command.h"

namespace weir::notify_test {
namespace {

/// The manager's end.
struct Manager {
  TemporaryDirectory directory;
  std::string path = directory / "notify";
  Descriptor socket{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};

  Manager() {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  std::string received() const {
    std::array<char, 256> text{};
    const ssize_t bytes = ::recv(socket.get(), text.data(), text.size(), MSG_DONTWAIT);
    return bytes < 0 ? "nothing" : std::string(text.data(), static_cast<std::size_t>(bytes));
  }
};

TEST(ServiceNotifier, SendsToTheSocketOfTheEnvironmentAndHidesItFromChildren) {
  const Manager manager;
  ::setenv("NOTIFY_SOCKET", manager.path.c_str(), 1);
  ::setenv("WATCHDOG_USEC", "3000000", 1);
  ::setenv("WATCHDOG_PID", cat(::getpid()).c_str(), 1);
  const ServiceNotifier notifier = ServiceNotifier::from_environment();
  EXPECT_EQ(notifier.watchdog(), std::chrono::seconds(3));
  for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) EXPECT_EQ(std::getenv(name), nullptr);
  notifier.send("READY=1\nSTATUS=watching");
  EXPECT_EQ(manager.received(), "READY=1\nSTATUS=watching");
}

TEST(ServiceNotifier, WatchdogOfAnotherProcess_IsIgnored) {
  ::setenv("WATCHDOG_USEC", "3000000", 1);
  ::setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(ServiceNotifier::from_environment().watchdog(), std::nullopt);
}

TEST(ServiceNotifier, DoesNothingWhereNobodyListens) {
  const Manager another;
  ::unsetenv("NOTIFY_SOCKET");
  const std::string nowhere = another.directory / "nowhere";
  const std::string too_long = another.path + std::string(300, 'x');
  for (const ServiceNotifier& notifier : {ServiceNotifier::from_environment(), ServiceNotifier(nowhere, std::nullopt),
                                          ServiceNotifier(too_long, std::nullopt)}) {
    EXPECT_NO_THROW(notifier.send("READY=1"));
    EXPECT_EQ(notifier.watchdog(), std::nullopt);
  }
  EXPECT_EQ(another.received(), "nothing");
  EXPECT_EQ(list_directory(another.directory.path()), std::vector<std::string>{"notify"}) << "no socket was made";
}

}  // namespace
}  // namespace weir::notify_test
