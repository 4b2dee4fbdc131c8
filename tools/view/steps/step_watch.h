// Repeatedly looks which steps a series has while a simulation adds to it. Lives on the io_context's thread but looks
// on another thread, because a file server may be slow.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <memory>

#include "tools/view/steps/step_list.h"
#include "tools/view/steps/viewed_files.h"

namespace weir {

class StepWatch {
 public:
  using Changed = std::function<void(const SeriesSummary& summary)>;

  /// Updates `steps` every `period`, or later if a look takes long, so that looking costs at most a twentieth of a
  /// core. Calls `changed` with the summary of all steps seen, when steps are added or removed or the common values
  /// change. A file whose head cannot be read yet is not a step yet. `pool` and `steps` must outlive the object and
  /// the work it gave to `pool`.
  StepWatch(boost::asio::io_context& io, boost::asio::thread_pool& pool, StepList& steps, const ViewedFiles& files,
            std::chrono::milliseconds period, Changed changed);

 private:
  void wait(std::chrono::steady_clock::duration pause);
  void look();

  boost::asio::io_context& io_;
  boost::asio::thread_pool& pool_;
  StepList& steps_;
  const StepChoice choice_;
  const std::chrono::milliseconds period_;
  Changed changed_;
  std::shared_ptr<SeriesHeads> heads_;  // used by the look under way, while there is one
  boost::asio::steady_timer timer_;
  std::shared_ptr<int> alive_ = std::make_shared<int>(0);
};

}  // namespace weir
