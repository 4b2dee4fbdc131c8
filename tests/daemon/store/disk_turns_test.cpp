#include "daemon/store/disk_turns.h"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <string>

namespace weir::disk_turns_test {
namespace {

TEST(DiskTurns, HandlerPostedDuringATurn_RunsBeforeTheNextTurn) {
  boost::asio::io_context io;
  DiskTurns turns(io);
  std::string order;
  const auto turn = [&](char name) {
    return [&, name] {
      order += name;
      boost::asio::post(io, [&] { order += '.'; });
    };
  };
  turns.take(turn('a'));
  turns.take(turn('b'));
  turns.take(turn('c'));
  io.run();
  EXPECT_EQ(order, "a.b.c.");
}

TEST(DiskTurns, TurnTakenDuringATurn_RunsAfterThoseWaiting) {
  boost::asio::io_context io;
  DiskTurns turns(io);
  std::string order;
  turns.take([&] {
    order += 'a';
    turns.take([&] { order += 'c'; });
  });
  turns.take([&] { order += 'b'; });
  io.run();
  EXPECT_EQ(order, "abc");
  turns.take([&] { order += 'd'; });
  io.restart();
  io.run();
  EXPECT_EQ(order, "abcd");
}

}  // namespace
}  // namespace weir::disk_turns_test
