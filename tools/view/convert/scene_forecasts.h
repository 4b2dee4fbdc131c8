// What conversions for scenes would come to: `weir convert --dry-run`, as a process of its own, one at a time. A page's
// newest question counts; one that nobody waits for any more is given up. What was found is kept for whoever asks the
// same. Lives on the io_context's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/view/base/view_message.h"
#include "tools/view/convert/kept_scene.h"
#include "tools/view/convert/scene_conversion.h"

namespace weir {

class WorkerProcess;

class SceneForecasts {
 public:
  /// `answer` is {"type": "forecast", "id", "state": "done" or "failed", ...}: docs/view.md.
  using Told = std::function<void(ViewerId viewer, const nlohmann::ordered_json& answer)>;

  /// `program` is the path of weir, `options` more options of its convert.
  SceneForecasts(boost::asio::io_context& io, std::string program, std::vector<std::string> options, Told told);
  /// Kills the one that runs.
  ~SceneForecasts();

  /// Answers in any case, by `told`, unless another question of that viewer comes before or it is forgotten.
  void ask(ViewerId viewer, std::int64_t id, const SceneConversion& conversion, const std::string& scene_text);
  void forget(ViewerId viewer);

 private:
  struct Question {
    std::uint64_t turn = 0;  // those asked first are answered first
    std::int64_t id = 0;
    std::string key;  // what is asked, as a text
    SceneConversion conversion;
    std::string scene_text;
  };

  void next();
  void start(const Question& question);
  void keep(const std::string& key, nlohmann::ordered_json answer);
  bool is_waited_for(const std::string& key) const;

  boost::asio::io_context& io_;
  const std::string program_;
  const std::vector<std::string> options_;
  const Told told_;
  std::map<ViewerId, Question> waiting_;
  std::uint64_t turns_ = 0;
  std::map<std::string, nlohmann::ordered_json> answers_;  // by key
  KeptScene kept_scene_;
  std::string running_;  // key of what the worker finds
  std::unique_ptr<WorkerProcess> worker_;
};

}  // namespace weir
