#include "tools/view/base/stop_signals.h"

#include <gtest/gtest.h>

#include <csignal>

namespace weir::stop_signals_test {
namespace {

// Returns true if the first signal stops the io_context and the process goes on.
bool stops_at(int signal) {
  boost::asio::io_context io;
  const StopSignals signals(io, [&] { io.stop(); });
  std::raise(signal);
  io.run();
  return io.stopped();
}

TEST(StopSignals, SecondSignal_EndsTheProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(
        {
          std::signal(SIGHUP, SIG_DFL);  // whatever started the test
          boost::asio::io_context io;
          const StopSignals signals(io, [&] { io.stop(); });
          std::raise(signal);
          io.run();
          std::raise(signal);
        },
        testing::KilledBySignal(signal), "");
  }
}

TEST(StopSignals, FirstSignal_StopsAndTheProcessGoesOn) {
  EXPECT_TRUE(stops_at(SIGINT));
  EXPECT_TRUE(stops_at(SIGTERM));
}

}  // namespace
}  // namespace weir::stop_signals_test
