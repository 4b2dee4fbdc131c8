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

constexpr std::size_t kMostKept = 256;  // number of answers, some 300 bytes each
constexpr int kNice = 10;               // rendering has priority
constexpr std::chrono::milliseconds kReapWait{100};
constexpr std::chrono::milliseconds kSettle{200};  // how long a question must stand before a process is started
constexpr std::chrono::milliseconds kGrace{500};   // time for a stopped process to remove its files

Json failure(const std::string& message) { return {{"state", "failed"}, {"message", message}}; }

Json figures_of(const Json& found) {
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

// Returns the answer from the output of `weir convert --dry-run --json`.
Json answer_of(const std::string& text) {
  try {
    return figures_of(Json::parse(text));
  } catch (const Json::exception&) {
    return failure("weir convert --dry-run gave no figures of one volume");
  }
}

// Rewords a failure about memory: the reader can set what the share comes from, but not --memory.
std::string reason_of(const WorkerEnd& end) {
  constexpr std::string_view kRemedy = "give at least ";
  const std::string reason = worker_reason("convert", end);
  if (reason.find("--memory") == std::string::npos) return reason;
  const std::size_t remedy = reason.rfind(kRemedy);
  const std::string needs =
      remedy == std::string::npos ? "" : cat(", it needs ", reason.substr(remedy + kRemedy.size()));
  return cat(
      "the memory set aside for a forecast is too little for this volume", needs,
      "; give more by --forecast-memory of weir view, or by viewer_memory of weir watch, of which it is a share");
}

}  // namespace

SceneForecasts::SceneForecasts(boost::asio::io_context& io, std::string program, std::vector<std::string> options,
                               Told told)
    : io_(io), program_(std::move(program)), options_(std::move(options)), told_(std::move(told)), settle_(io) {}

SceneForecasts::~SceneForecasts() = default;

void SceneForecasts::ask(ViewerId viewer, std::int64_t id, const SceneConversion& conversion,
                         const std::string& scene_text) {
  const std::string key = cat(file_identity(conversion.arguments.at(1)), '\n', conversion.text, '\n', scene_text);
  waiting_[viewer] = {std::chrono::steady_clock::now(), id, key, conversion, scene_text};
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
  std::vector<std::string> known;
  for (const auto& [viewer, asked] : waiting_) {
    if (answers_.contains(asked.key)) known.push_back(asked.key);
  }
  for (const std::string& key : known) answer(key, answers_.at(key));
  if (worker_ && !ending_ && !is_waited_for(running_)) {
    ending_ = true;
    worker_->stop(kGrace);
  }
  settle_.cancel();
  if (!worker_ && !waiting_.empty()) {
    const Question& first = std::min_element(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
                              return a.second.asked < b.second.asked;
                            })->second;
    settle_.expires_at(first.asked + kSettle);
    settle_.async_wait([this, key = first.key, alive = std::weak_ptr(alive_)](const boost::system::error_code& error) {
      if (!error && alive.lock() && !worker_) start(key);
    });
  }
  for (const auto& [viewer, text] : std::exchange(due_, {})) told_(viewer, text);  // last: may forget the viewer
}

// Starts the forecast. A failure to start also gives an answer.
void SceneForecasts::start(const std::string& key) {
  const auto asked =
      std::find_if(waiting_.begin(), waiting_.end(), [&](const auto& each) { return each.second.key == key; });
  if (asked == waiting_.end()) return next();  // another question came in the timer's place
  running_ = key;
  ending_ = false;
  try {
    std::vector<std::string> arguments =
        conversion_command(asked->second.conversion, kept_scene_.write(asked->second.scene_text));
    // An existing output must not prevent a forecast.
    arguments.insert(arguments.end(), {"--overwrite", "--dry-run", "--json", "--quiet"});
    arguments.insert(arguments.end(), options_.begin(), options_.end());
    worker_ = std::make_unique<WorkerProcess>(
        io_, WorkerCommand{program_, arguments, kNice, IoClass::none, kReapWait}, [](std::string_view) {},
        [this](const WorkerEnd& end) { ended(end); });
  } catch (const Error& error) {
    answer(key, failure(error.what()));
    next();
  }
}

// A stopped process says nothing about its question, which may have been asked again since.
void SceneForecasts::ended(const WorkerEnd& end) {
  worker_.reset();
  if (end.exit_code == 0) {
    const Json found = answer_of(end.log);
    if (found.at("state") == "done") keep(running_, found);
    answer(running_, found);
  } else if (!ending_) {
    answer(running_, failure(reason_of(end)));
  }
  next();
}

void SceneForecasts::answer(const std::string& key, const Json& found) {
  std::erase_if(waiting_, [&](const auto& asked) {
    if (asked.second.key != key) return false;
    Json text{{"type", "forecast"}, {"id", asked.second.id}};
    text.update(found);
    due_.emplace_back(asked.first, std::move(text));
    return true;
  });
}

// Keeps a result. Failures are not kept, because they may succeed the next time.
void SceneForecasts::keep(const std::string& key, const Json& found) {
  if (answers_.size() >= kMostKept) answers_.clear();
  answers_[key] = found;
}

}  // namespace weir
