#include "tools/view/convert/scene_forecasts.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "daemon/jobs/worker_process.h"
#include "daemon/jobs/worker_reason.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "tools/view/base/file_identity.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostKept = 256;  // answers, some 300 bytes each
constexpr int kNice = 10;               // pictures come first
constexpr std::chrono::milliseconds kReapWait{100};

Json failure(const std::string& message) { return {{"state", "failed"}, {"message", message}}; }

// Of what `weir convert --dry-run --json` printed.
Json answer_of(const std::string& text) {
  const Json found = Json::parse(text, nullptr, false);
  if (!found.is_object()) return failure("weir convert --dry-run gave no figures");
  const Json& error = found.at("error");
  const Json& shown = found.at("visible");
  return {{"state", "done"},
          {"exact", found.at("exact")},
          {"share", found.at("sample").at("share")},
          {"none", found.at("sample").at("none")},
          {"bytes", found.at("file")},
          {"lossless", error.is_null() ? Json(false) : error.at("lossless")},
          {"psnr_db", error.is_null() ? Json() : error.at("psnr_db")},
          {"max_abs", error.is_null() ? Json() : error.at("max_abs")},
          {"visible", shown.is_null() ? Json()
                                      : Json{{"lossless", shown.at("lossless")},
                                             {"psnr_db", shown.at("psnr_db")},
                                             {"share", shown.at("share")}}},
          {"total_s", found.at("time").is_null() ? Json() : found.at("time").at("total_s")}};
}

}  // namespace

SceneForecasts::SceneForecasts(boost::asio::io_context& io, std::string program, std::vector<std::string> options,
                               Told told)
    : io_(io), program_(std::move(program)), options_(std::move(options)), told_(std::move(told)) {}

SceneForecasts::~SceneForecasts() = default;

void SceneForecasts::ask(ViewerId viewer, std::int64_t id, const SceneConversion& conversion,
                         const std::string& scene_text) {
  const std::string key = cat(file_identity(conversion.arguments.at(1)), '\n', conversion.text, '\n', scene_text);
  waiting_[viewer] = {++turns_, id, key, conversion, scene_text};
  next();
}

void SceneForecasts::forget(ViewerId viewer) {
  waiting_.erase(viewer);
  next();
}

bool SceneForecasts::is_waited_for(const std::string& key) const {
  return std::any_of(waiting_.begin(), waiting_.end(), [&](const auto& asked) { return asked.second.key == key; });
}

void SceneForecasts::next() {
  std::vector<std::pair<ViewerId, Json>> known;
  for (;;) {
    std::erase_if(waiting_, [&](const auto& asked) {
      const auto found = answers_.find(asked.second.key);
      if (found == answers_.end()) return false;
      Json answer{{"type", "forecast"}, {"id", asked.second.id}};
      answer.update(found->second);
      known.emplace_back(asked.first, std::move(answer));
      return true;
    });
    if (worker_ && !is_waited_for(running_)) worker_.reset();
    if (worker_ || waiting_.empty()) break;
    start(std::min_element(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
            return a.second.turn < b.second.turn;
          })->second);
  }
  for (const auto& [viewer, answer] : known) told_(viewer, answer);  // last: one that reads nothing is gone after it
}

// Where that fails there is an answer, too.
void SceneForecasts::start(const Question& question) {
  running_ = question.key;
  try {
    std::vector<std::string> arguments =
        conversion_command(question.conversion, kept_scene_.write(question.scene_text));
    // An output of before is not in the way of a forecast.
    arguments.insert(arguments.end(), {"--overwrite", "--dry-run", "--json", "--quiet"});
    arguments.insert(arguments.end(), options_.begin(), options_.end());
    worker_ = std::make_unique<WorkerProcess>(
        io_, WorkerCommand{program_, arguments, kNice, IoClass::none, kReapWait}, [](std::string_view) {},
        [this](const WorkerEnd& end) {
          worker_.reset();
          keep(running_, end.exit_code == 0 ? answer_of(end.log) : failure(worker_reason("convert", end)));
          next();
        });
  } catch (const Error& error) {
    keep(running_, failure(error.what()));
  }
}

void SceneForecasts::keep(const std::string& key, Json answer) {
  if (answers_.size() >= kMostKept) answers_.clear();
  answers_[key] = std::move(answer);
}

}  // namespace weir
