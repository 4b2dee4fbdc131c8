// Looks again and again which steps a series has, for as long as a simulation adds to it. Lives on the io_context's
// thread, looks on another one: a file server may take its time.
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

  /// Brings `steps` up to date every `period`, later where a look takes long, so that it costs a twentieth of a core at
  /// most; `changed` is called where other ones are there or have other values in common, with the summary of all that
  /// were seen. A file whose head cannot be read yet is no step yet. `pool` and `steps` must outlive the object and
  /// what it has asked of `pool`.
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
  std::shared_ptr<SeriesHeads> heads_;  // of the look that is under way, while there is one
  boost::asio::steady_timer timer_;
  std::shared_ptr<int> alive_ = std::make_shared<int>(0);
};

}  // namespace weir
