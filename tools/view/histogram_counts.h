// Counts histograms for all viewers. Each histogram is counted once, one at a time, in a separate thread, because a
// file without a certificate has to be read whole. A histogram that nobody waits for any more is not counted. Lives on
// the io_context's thread.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <set>
#include <string>

#include "tools/view/kept_texts.h"
#include "tools/view/render_loop.h"

namespace weir {

struct HistogramQuestion {
  std::size_t step = 0;
  int side = 0;
  std::string path;
};

class HistogramCounts {
 public:
  /// Returns the text for the viewers. Called in the counting thread; ends soon after `cancel` is set. May throw.
  using Count = std::function<std::string(const HistogramQuestion&, const std::atomic<bool>& cancel)>;
  using Tell = std::function<void(ViewerId, const std::string& text)>;

  HistogramCounts(boost::asio::io_context& io, Count count, Tell tell);
  /// Cancels the count that is under way and waits for its end.
  ~HistogramCounts();
  HistogramCounts(const HistogramCounts&) = delete;
  HistogramCounts& operator=(const HistogramCounts&) = delete;

  /// Tells the viewer when the histogram is counted, unless it asks for another histogram of the same side before.
  void ask(ViewerId viewer, HistogramQuestion question);
  void forget(ViewerId viewer);

 private:
  struct Job {
    std::string key;  // identity of the file that the path names now
    HistogramQuestion question;
    std::set<ViewerId> viewers;
  };

  void leave(ViewerId viewer, int side);
  void count_next();
  void counted(const std::string& text);

  boost::asio::io_context& io_;
  const Count count_;
  const Tell tell_;
  KeptTexts known_;
  std::list<Job> jobs_;  // the first job is under way if counting_
  bool counting_ = false;
  std::atomic<bool> cancel_{false};
  std::shared_ptr<int> alive_ = std::make_shared<int>(0);
  boost::asio::thread_pool thread_{1};
};

}  // namespace weir
