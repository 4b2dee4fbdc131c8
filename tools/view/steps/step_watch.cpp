#include "tools/view/steps/step_watch.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"

namespace weir {
namespace {

constexpr int kRest = 19;  // the pause, as a multiple of the duration of a look

// Returns the present steps after `heads` has read their heads; empty if they cannot be listed.
std::vector<std::string> seen_steps(const StepChoice& choice, const StepList& steps, SeriesHeads& heads) {
  const std::vector<std::string> paths = steps.paths();
  const std::set<std::string> known(paths.begin(), paths.end());
  std::vector<std::string> seen;
  try {
    for (std::string& path : find_steps(choice)) {
      const bool whole = heads.look_at(path);
      if (whole || known.contains(path)) seen.push_back(std::move(path));
    }
  } catch (const Error&) {
  }
  return seen;
}

bool same_values(const SeriesSummary& a, const SeriesSummary& b) {
  const auto ends = [](const SeriesSummary& s) {
    return s.range ? std::optional(std::pair(s.range->min, s.range->max)) : std::nullopt;
  };
  return ends(a) == ends(b) && a.background == b.background;
}

}  // namespace

StepWatch::StepWatch(boost::asio::io_context& io, boost::asio::thread_pool& pool, StepList& steps,
                     const ViewedFiles& files, std::chrono::milliseconds period, Changed changed)
    : io_(io),
      pool_(pool),
      steps_(steps),
      choice_(files.choice),
      period_(period),
      changed_(std::move(changed)),
      heads_(std::make_shared<SeriesHeads>(files.heads)),
      timer_(io) {
  wait(period_);
}

void StepWatch::wait(std::chrono::steady_clock::duration pause) {
  timer_.expires_after(pause);
  timer_.async_wait([this](boost::system::error_code error) {
    if (!error) look();
  });
}

void StepWatch::look() {
  boost::asio::post(
      pool_, [this, &io = io_, &steps = steps_, choice = choice_, heads = heads_, alive = std::weak_ptr(alive_)] {
        const auto begin = std::chrono::steady_clock::now();
        const SeriesSummary before = heads->summary();
        const bool others = steps.update(seen_steps(choice, steps, *heads));
        const bool other = others || !same_values(before, heads->summary());
        const auto took = std::chrono::steady_clock::now() - begin;
        boost::asio::post(io, [this, other, took, alive] {
          if (!alive.lock()) return;
          if (other) changed_(heads_->summary());
          wait(std::max<std::chrono::steady_clock::duration>(period_, kRest * took));
        });
      });
}

}  // namespace weir
