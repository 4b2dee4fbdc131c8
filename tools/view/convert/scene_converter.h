// Runs one conversion for a scene at a time, as a separate process. The viewer that asked keeps track of what it asked
// for. Lives on the io_context's thread.
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
  /// `message` is the reason of a failure, one line; empty if `output` was made.
  using Ended = std::function<void(const std::string& output, const std::string& message)>;

  /// `program` is the path of weir.
  SceneConverter(boost::asio::io_context& io, std::string program);
  /// Kills a conversion that still runs; its partial files are kept, so that it can be resumed.
  ~SceneConverter();

  bool running() const { return worker_ != nullptr; }
  /// Starts the conversion. Throws Error(io) if the process cannot be started, Error(usage) if a conversion is
  /// running.
  void start(const SceneConversion& conversion, const std::string& scene_text, Ended ended);

 private:
  boost::asio::io_context& io_;
  std::string program_;
  KeptScene kept_scene_;
  std::unique_ptr<WorkerProcess> worker_;
};

}  // namespace weir
