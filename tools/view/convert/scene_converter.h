// Runs one conversion for a scene at a time, as a process of its own; what it was made for is known to the viewer that
// asked. Lives on the io_context's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "tools/view/convert/kept_scene.h"
#include "tools/view/convert/scene_conversion.h"

namespace weir {

class WorkerProcess;

class SceneConverter {
 public:
  /// `message` is the reason where it failed, one line; empty where `output` is there.
  using Ended = std::function<void(const std::string& output, const std::string& message)>;

  /// `program` is the path of weir.
  SceneConverter(boost::asio::io_context& io, std::string program);
  /// A conversion that still runs is killed; its partial files are kept to be resumed.
  ~SceneConverter();

  bool running() const { return worker_ != nullptr; }
  /// Throws Error(io) where it cannot be started, Error(usage) where one runs.
  void start(const SceneConversion& conversion, const std::string& scene_text, Ended ended);

 private:
  boost::asio::io_context& io_;
  std::string program_;
  KeptScene kept_scene_;
  std::unique_ptr<WorkerProcess> worker_;
};

}  // namespace weir
