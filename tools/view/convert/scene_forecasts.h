// Forecasts conversions for scenes with `weir convert --dry-run`, a separate process, one at a time. Only a page's
// newest question counts, after it has stood for a moment. A forecast that nobody waits for any more is stopped, and
// the next one begins when its process has ended. Results are kept for later equal questions; failures are not. Lives
// on the io_context's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tools/view/base/view_message.h"
#include "tools/view/convert/kept_scene.h"
#include "tools/view/convert/scene_conversion.h"

namespace weir {

class WorkerProcess;
struct WorkerEnd;

class SceneForecasts {
 public:
  /// `answer` is {"type": "forecast", "id", "state": "done" or "failed", ...}: docs/view.md.
  using Told = std::function<void(ViewerId viewer, const nlohmann::ordered_json& answer)>;

  /// `program` is the path of weir, `options` are further options for its convert.
  SceneForecasts(boost::asio::io_context& io, std::string program, std::vector<std::string> options, Told told);
  /// Kills a running forecast.
  ~SceneForecasts();

  /// Always answers by `told`, unless that viewer asks another question first or is forgotten.
  void ask(ViewerId viewer, std::int64_t id, const SceneConversion& conversion, const std::string& scene_text);
  void forget(ViewerId viewer);

 private:
  struct Question {
    std::chrono::steady_clock::time_point asked;  // questions are answered in the order in which they were asked
    std::int64_t id = 0;
    std::string key;  // the question as a text
    SceneConversion conversion;
    std::string scene_text;
  };

  void next();
  void start(const std::string& key);
  void ended(const WorkerEnd& end);
  void answer(const std::string& key, const nlohmann::ordered_json& found);
  void keep(const std::string& key, const nlohmann::ordered_json& found);
  bool is_waited_for(const std::string& key) const;

  boost::asio::io_context& io_;
  const std::string program_;
  const std::vector<std::string> options_;
  const Told told_;
  std::map<ViewerId, Question> waiting_;
  std::vector<std::pair<ViewerId, nlohmann::ordered_json>> due_;  // answers to be told next
  std::map<std::string, nlohmann::ordered_json> answers_;         // answers by key
  KeptScene kept_scene_;
  std::string running_;  // key of the question that the worker answers
  bool ending_ = false;  // the running forecast is being stopped
  boost::asio::steady_timer settle_;
  std::shared_ptr<int> alive_ = std::make_shared<int>(0);  // for a timer that has fired but not run yet
  std::unique_ptr<WorkerProcess> worker_;
};

}  // namespace weir
