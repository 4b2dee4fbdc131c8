#include "compressor/team/team.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/compressor/support/thread_team.h"

namespace weir::team_test {
namespace {

// Returns the results of `work` on each of `size` ranks, by rank.
template <typename Result>
std::vector<Result> on_ranks(int size, const std::function<Result(Team&)>& work) {
  std::vector<Result> results(static_cast<std::size_t>(size));
  ThreadTeam(size).run([&](Team& team) { results[static_cast<std::size_t>(team.rank())] = work(team); });
  return results;
}

std::string failure_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return cat(error.exit_code(), ' ', error.what());
  }
  return "none";
}

TEST(Team, SharesFollowEachOtherAndDifferByOneAtMost) {
  for (const int size : {1, 2, 3, 8}) {
    for (const std::int64_t count : {0, 1, 7, 8, 1000}) {
      const auto shares = on_ranks<Share>(size, [&](Team& team) { return team.share(count); });
      std::int64_t at = 0;
      for (const Share& share : shares) {
        EXPECT_EQ(share.begin, at);
        EXPECT_GE(share.end - share.begin, count / size);
        EXPECT_LE(share.end - share.begin, count / size + 1);
        at = share.end;
      }
      EXPECT_EQ(at, count);
    }
  }
}

TEST(Team, SingleRankKeepsItsItems) {
  Team& team = no_team();
  EXPECT_TRUE(team.alone());
  EXPECT_TRUE(team.leads());
  std::vector<int> items{3, 1, 4};
  team.sum<int>(items);
  team.concatenate(items);
  team.gather(items);
  team.follow(items);
  EXPECT_EQ(items, (std::vector<int>{3, 1, 4}));
  EXPECT_EQ(failure_of([&] { team.run([] { throw Error(ErrorKind::io, "full"); }); }), "5 full");
}

TEST(Team, SumsConcatenatesGathersAndFollows) {
  using Items = std::vector<unsigned __int128>;
  const auto sums = on_ranks<Items>(5, [](Team& team) {
    Items items{static_cast<unsigned __int128>(team.rank()) << 100U, 1};
    team.sum<unsigned __int128>(items);
    return items;
  });
  for (const Items& items : sums) EXPECT_TRUE((items == Items{static_cast<unsigned __int128>(10) << 100U, 5}));

  const auto all = on_ranks<std::vector<int>>(4, [](Team& team) {
    std::vector<int> items(static_cast<std::size_t>(team.rank()), team.rank());  // rank 0 has no items
    team.concatenate(items);
    return items;
  });
  for (const auto& items : all) EXPECT_EQ(items, (std::vector<int>{1, 2, 2, 3, 3, 3}));

  const auto gathered = on_ranks<std::vector<int>>(3, [](Team& team) {
    std::vector<int> items(8, -1);
    const Share own = team.share(8);
    std::iota(items.begin() + own.begin, items.begin() + own.end, static_cast<int>(own.begin));
    team.gather(items);
    return items;
  });
  for (const auto& items : gathered) EXPECT_EQ(items, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));

  const auto followed = on_ranks<int>(3, [](Team& team) {
    bool truth = team.leads();
    team.follow(truth);
    int number = 7 + team.rank();
    team.follow(number);
    return truth ? number : -1;
  });
  EXPECT_EQ(followed, (std::vector<int>{7, 7, 7}));
}

TEST(Team, ErrorsNameOptionsAsEachProcessDoes) {
  const auto lines = on_ranks<std::string>(2, [](Team& team) {
    try {
      team.run([&] {
        if (team.rank() == 1) throw usage_error(compose("choose ", option("missing-policy", "keep")));
      });
    } catch (const Error& error) {
      return error.message().worded(key_wording);
    }
    return std::string("none");
  });
  EXPECT_EQ(lines, std::vector<std::string>(2, "choose missing_policy keep"));
}

TEST(Team, ErrorOfTheLowestRankReachesEveryRank) {
  const auto errors = on_ranks<std::string>(4, [](Team& team) {
    return failure_of([&] {
      team.run([&] {
        if (team.rank() == 3) throw Error(ErrorKind::io, "disk of 3");
        if (team.rank() == 2) throw std::runtime_error("fault of 2");
      });
    });
  });
  EXPECT_EQ(errors, std::vector<std::string>(4, "1 fault of 2"));

  const auto led = on_ranks<std::string>(3, [](Team& team) {
    return failure_of([&] { team.lead([&] { throw Error(ErrorKind::usage, cat("of ", team.rank())); }); });
  });
  EXPECT_EQ(led, std::vector<std::string>(3, "2 of 0"));
}

}  // namespace
}  // namespace weir::team_test
