#include "tools/view/histogram_counts.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <exception>
#include <utility>

#include "format/base/text.h"
#include "tools/view/base/file_identity.h"
#include "tools/view/base/view_message.h"

namespace weir {

HistogramCounts::HistogramCounts(boost::asio::io_context& io, Count count, Tell tell)
    : io_(io), count_(std::move(count)), tell_(std::move(tell)) {}

HistogramCounts::~HistogramCounts() {
  alive_.reset();
  cancel_ = true;
  thread_.stop();
  thread_.join();
}

void HistogramCounts::ask(ViewerId viewer, HistogramQuestion question) {
  const std::string key = cat(question.step, ' ', question.side, ' ', file_identity(question.path));
  const auto found = std::find_if(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.key == key; });
  if (found != jobs_.end() && found->viewers.contains(viewer)) return;
  leave(viewer, question.side);
  if (found != jobs_.end()) {
    found->viewers.insert(viewer);
  } else {
    jobs_.push_back({key, std::move(question), {viewer}});
  }
  count_next();
}

void HistogramCounts::forget(ViewerId viewer) {
  for (const int side : {0, 1}) leave(viewer, side);
}

void HistogramCounts::leave(ViewerId viewer, int side) {
  for (auto job = jobs_.begin(); job != jobs_.end();) {
    const bool left = job->question.side == side && job->viewers.erase(viewer) > 0 && job->viewers.empty();
    const bool under_way = counting_ && job == jobs_.begin();
    if (left && under_way) cancel_ = true;
    job = left && !under_way ? jobs_.erase(job) : std::next(job);
  }
}

void HistogramCounts::count_next() {
  if (counting_ || jobs_.empty()) return;
  counting_ = true;
  cancel_ = false;
  const Job& job = jobs_.front();
  boost::asio::post(thread_, [this, key = job.key, question = job.question, alive = std::weak_ptr(alive_)] {
    std::string text;
    try {
      text = known_.get(key, [&] { return count_(question, cancel_); });
    } catch (const std::exception& error) {
      text = error_message(0, error.what());
    }
    boost::asio::post(io_, [this, alive, text] {
      if (alive.lock()) counted(text);
    });
  });
}

void HistogramCounts::counted(const std::string& text) {
  const Job job = std::move(jobs_.front());
  jobs_.pop_front();
  counting_ = false;
  const bool cancelled = cancel_.exchange(false);
  // Viewers that came after the count was cancelled wait for another count.
  if (cancelled && !job.viewers.empty()) jobs_.push_front(job);
  if (!cancelled) {
    for (const ViewerId viewer : job.viewers) tell_(viewer, text);
  }
  count_next();
}

}  // namespace weir
