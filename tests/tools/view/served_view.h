// A ViewServer on a free loopback port, run by its own thread.
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <cstddef>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "tools/view/view_server.h"

namespace weir {

class ServedView {
 public:
  explicit ServedView(const std::string& input, const std::string& against = "", ViewSettings settings = {},
                      const VoxelMemory& memory = {})
      : backend_(make_cpu_backend(0, memory)),
        server_(std::make_unique<ViewServer>(io_, std::move(settings), find_viewed_files({input}, against), *backend_)),
        port_(server_->port()),
        thread_([this] { io_.run(); }) {}
  ~ServedView() {
    boost::asio::post(io_, [this] {
      server_.reset();
      work_.reset();
    });
    thread_.join();
  }
  ServedView(const ServedView&) = delete;
  ServedView& operator=(const ServedView&) = delete;

  std::uint16_t port() const { return port_; }
  std::size_t viewers() {
    std::promise<std::size_t> answer;
    boost::asio::post(io_, [&] { answer.set_value(server_->viewers()); });
    return answer.get_future().get();
  }

 private:
  boost::asio::io_context io_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
  std::unique_ptr<Backend> backend_;
  std::unique_ptr<ViewServer> server_;
  std::uint16_t port_;
  std::thread thread_;
};

}  // namespace weir
