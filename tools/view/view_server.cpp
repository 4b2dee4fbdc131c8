#include "tools/view/view_server.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "daemon/http/page_response.h"
#include "daemon/http/request_target.h"
#include "daemon/http/socket_token.h"
#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/text.h"
#include "tools/options/backend_choice.h"
#include "tools/view/base/file_identity.h"
#include "tools/view/compared_scene.h"
#include "tools/view/value_probe.h"
#include "tools/view/view_access.h"
#include "tools/view/view_page.h"
#include "tools/view/volume_facts.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;
namespace websocket = boost::beast::websocket;

std::string line(const Json& json) { return json_text(json); }

AccessRules rules_of(const ViewSettings& settings) {
  const bool loopback = is_loopback(settings.address.host);
  if (!loopback && settings.token.empty()) {
    throw Error(ErrorKind::usage,
                compose(option("listen", settings.address.text()), " can be reached from other machines, so it needs ",
                        option("token-file", "FILE"), "; or listen on 127.0.0.1"));
  }
  return {.token = settings.token,
          .loopback = loopback && !settings.any_host,
          .wrong_token =
              cat("the token is not this viewer's; take the one ",
                  settings.any_host ? "that it printed to --progress-fd" : "in the file that --token-file names")};
}

// Returns the background for pictures. A single file uses its own background, as in weir render.
std::optional<float> picture_background(const ViewedFiles& files) {
  return files.series() ? files.heads.summary().background : std::nullopt;
}

bool is_page_file(const RequestTarget& target) {
  return target.path.empty() || (target.path.size() == 2 && target.path[0] == "page");
}

}  // namespace

ViewServer::ViewServer(boost::asio::io_context& io, ViewSettings settings, ViewedFiles files, Backend& backend)
    : io_(io),
      settings_(std::move(settings)),
      files_(std::move(files)),
      summary_(files_.heads.summary()),
      steps_(files_.steps),
      rules_(rules_of(settings_)),
      backend_(backend),
      cameras_(own_macrocell(backend)),
      shelf_(backend, volumes_held(files_)),
      scene_requests_(io,
                      {settings_.program, settings_.preview_of, settings_.allow_convert, settings_.forecast,
                       settings_.forecast_options},
                      open_files_, [this](ViewerId id, const Json& message) { send(id, line(message)); }) {
  state_text_ = line({{"title", files_.title},
                      {"series", files_.key},
                      {"version", settings_.version},
                      {"grows", files_.grow},
                      {"against", against_names_},
                      {"preview_of", settings_.preview_of.empty() ? Json() : Json(settings_.preview_of)},
                      {"render_input", settings_.render_input.empty() ? Json() : Json(settings_.render_input)},
                      {"allow_convert", settings_.allow_convert},
                      {"backend", backend.name()},
                      {"most_pixels", settings_.pixels},
                      {"most_viewers", settings_.viewers},
                      {"colormaps", colormap_facts()}});
  histograms_.emplace(
      io_,
      [this](const HistogramQuestion& question, const std::atomic<bool>& cancel) {
        return count_histogram(question, cancel);
      },
      [this](ViewerId id, const std::string& text) { send(id, text); });
  loop_.emplace(backend_, shelf_, RenderedSeries{steps_, files_.against, picture_background(files_)}, render_events());
  if (files_.grow) {
    step_watch_.emplace(io_, side_, steps_, files_, settings_.look_again,
                        [this](const SeriesSummary& summary) { tell_steps(summary); });
  }
  http_ = std::make_unique<HttpServer>(
      io_, settings_.address, settings_.http, [this](const HttpRequest& request) { return answer(request); },
      SocketHandler{[this](const HttpRequest& request) { return refuse_viewer(request); },
                    [this](ViewerSocket::Socket socket, const UpgradeRequest& request) {
                      add_viewer(std::move(socket), request);
                    }});
}

ViewServer::~ViewServer() {
  alive_.reset();
  histograms_.reset();
  step_watch_.reset();
  http_.reset();
  for (auto& [id, viewer] : viewers_) viewer.socket->close_now();
  loop_.reset();
  side_.stop();
  side_.join();
}

HttpResponse ViewServer::answer(const HttpRequest& request) const {
  HttpResponse response = route(request);
  add_page_headers(response, socket_sources(request.host));
  return response;
}

HttpResponse ViewServer::route(const HttpRequest& request) const {
  const auto target = parse_target(request.target);
  const bool page = target && is_page_file(*target);
  if (request.method != "GET" && request.method != "HEAD") {
    return error_response(405, cat(request.method, " is not for ", request.target, "; use GET"));
  }
  if (auto refused = refuse(rules_, request, page)) return *std::move(refused);
  if (!target) return error_response(400, "the request's target is no path with parameters, each given once");
  if (page) {
    const std::string name = target->path.empty() ? "index.html" : target->path[1];
    return page_response({view_page_files(), page_files()}, name);
  }
  if (target->path == std::vector<std::string>{"api", "state"}) {
    Json state = Json::parse(state_text_);
    state["steps"] = steps_.names();
    state["order"] = steps_.order();
    state["viewers"] = viewers_.size();
    return {200, "application/json", line(state) + "\n", {}};
  }
  if (target->path == std::vector<std::string>{"ws"}) return error_response(426, "/ws is a WebSocket");
  return error_response(404, cat("there is nothing at ", request.target));
}

std::optional<HttpResponse> ViewServer::refuse_viewer(const HttpRequest& request) const {
  if (auto refused = refuse_socket(rules_, with_offered_token(request))) return refused;
  const auto target = parse_target(request.target);
  if (!target || target->path != std::vector<std::string>{"ws"}) {
    return error_response(404, cat("there is no WebSocket at ", request.target));
  }
  const auto series = target->query.find("series");
  if (series != target->query.end() && series->second != files_.key) {
    return error_response(409, cat("this viewer shows another series now: ", files_.title));
  }
  if (viewers_.size() >= settings_.viewers) {
    return error_response(503, cat("there are ", viewers_.size(), " pages, as many as there may be; close one"));
  }
  return std::nullopt;
}

void ViewServer::add_viewer(ViewerSocket::Socket socket, const UpgradeRequest& request) {
  const ViewerId id = ++last_id_;
  const auto offered = request[boost::beast::http::field::sec_websocket_protocol];
  const bool known = offers_protocol({offered.data(), offered.size()}, kViewProtocol);
  auto viewer =
      std::make_shared<ViewerSocket>(std::move(socket), settings_.sockets,
                                     ViewerSocket::Events{[this, id] {
                                                            viewers_[id].wanted = first_step();
                                                            tell_facts(id, viewers_[id]);
                                                          },
                                                          [this, id](std::string_view text) { receive(id, text); },
                                                          [this, id](std::string_view) { remove_viewer(id); }});
  viewers_[id].socket = viewer;
  viewer->accept(request, known ? std::string(kViewProtocol) : "");
}

void ViewServer::remove_viewer(ViewerId id) {
  loop_->remove(id);
  histograms_->forget(id);
  viewers_.erase(id);
  scene_requests_.forget(id);
}

void ViewServer::send(ViewerId id, std::string text) {
  const auto found = viewers_.find(id);
  if (found != viewers_.end()) found->second.socket->send_text(std::move(text));
}

void ViewServer::receive(ViewerId id, std::string_view text) {
  const auto found = viewers_.find(id);
  if (found == viewers_.end()) return;
  try {
    std::visit([&](auto&& message) { handle(id, found->second, std::forward<decltype(message)>(message)); },
               parse_client_message(text, steps_.count(), !files_.against.empty(), settings_.pixels));
  } catch (const std::exception& error) {
    send(id, refusal_message(text, error.what()));
  }
}

void ViewServer::handle(ViewerId id, Viewer& viewer, ViewRequest view) {
  viewer.view = std::make_shared<const ViewRequest>(view);
  if (viewer.told != view.step || viewer.told_of != told_file(view.step)) {
    viewer.wanted = view.step;
    tell_facts(id, viewer);
  }
  loop_->show(id, std::move(view));
}

void ViewServer::handle(ViewerId id, Viewer& viewer, const ShownMessage& shown) {
  viewer.socket->taken();
  loop_->taken(id, shown.frame);
}

void ViewServer::handle(ViewerId id, Viewer& viewer, const ProbeRequest& probe) {
  viewer.probe = probe;
  if (!viewer.probing) answer_probe(id, viewer);
}

std::string ViewServer::file_of(std::size_t step, int side) const {
  if (side == 0) return steps_.path(step);
  return files_.against.at(files_.against.size() == 1 ? 0 : step);
}

std::string ViewServer::name_of(std::size_t step, int side) const {
  if (side == 0) return steps_.name(step);
  return against_names_.at(files_.against.size() == 1 ? 0 : step);
}

// Identifies a step's facts, which also tell its name; the name changes when a step comes from another folder.
std::string ViewServer::told_file(std::size_t step) const {
  return cat(steps_.name(step), ' ', file_identity(steps_.path(step)));
}

// Returns the lowest number of the present steps: the named file's, if it is still there.
std::size_t ViewServer::first_step() const {
  const std::vector<std::size_t> order = steps_.order();  // never empty
  return *std::min_element(order.begin(), order.end());
}

// Tells the steps before any values of a wider range, because a page's facts are of the range it had then.
void ViewServer::tell_steps(const SeriesSummary& summary) {
  summary_ = summary;
  Json told{{"type", "steps"}, {"steps", steps_.names()}, {"order", steps_.order()}};
  told.update(values_facts(common_values()));
  const std::string text = line(told);
  std::vector<ViewerId> ids;  // copied: a viewer that reads nothing is removed after one text too many
  for (const auto& [id, viewer] : viewers_) ids.push_back(id);
  for (const ViewerId id : ids) send(id, text);
}

// Makes the facts of one step at a time: while a series is scrubbed through, only the newest step is asked for.
void ViewServer::tell_facts(ViewerId id, Viewer& viewer) {
  if (!viewer.wanted || viewer.telling) return;
  const std::size_t step = *std::exchange(viewer.wanted, std::nullopt);
  viewer.told = step;
  viewer.told_of = told_file(step);
  viewer.telling = true;
  boost::asio::post(side_, [this, id, step, common = common_values(), alive = std::weak_ptr(alive_)] {
    Facts found;
    for (const int side : sides()) {
      const std::string path = file_of(step, side);
      try {
        const SeenValues values = values_of(file_of(step, 0), common);
        const std::string name = name_of(step, side);
        const std::string key = cat(step, ' ', side, ' ', values.range.min, ' ', values.range.max, ' ', name, ' ');
        found.texts.push_back(facts_cache_.get(key + file_identity(path), [&] {
          Json facts{{"type", "facts"}, {"step", step}, {"side", side}};
          facts.update(volume_facts(*open_files_.get(path), name, values));
          return line(facts);
        }));
      } catch (const std::exception& error) {
        found.texts.push_back(error_message(0, error.what()));
        if (side == 0) found.readable = false;
      }
    }
    boost::asio::post(io_, [this, id, step, common, found, alive] {
      if (alive.lock()) tell_facts(id, step, common, found);
    });
  });
}

// Sends the facts of a step, which were made with the earlier `common` values. A histogram may come later.
void ViewServer::tell_facts(ViewerId id, std::size_t step, const SeenValues& common, const Facts& facts) {
  const auto asked = viewers_.find(id);
  // A page asks for no picture before it has facts. If a thousand steps cannot be read, it is told of one.
  const bool blank = !facts.readable && asked != viewers_.end() && !asked->second.view;
  if (!blank || step == first_step()) {
    for (const std::string& text : facts.texts) send(id, text);
  }
  if (facts.readable) {
    for (const int side : sides()) histograms_->ask(id, {step, side, file_of(step, side)});
  }
  const auto found = viewers_.find(id);
  if (found == viewers_.end()) return histograms_->forget(id);
  const MinMax now = common_values().range;
  const bool older = now.min != common.range.min || now.max != common.range.max;  // a wider range was told since
  if (older && !found->second.wanted) found->second.wanted = step;
  found->second.telling = false;
  if (blank && !found->second.wanted) return tell_facts_of_another(id, found->second, step);
  tell_facts(id, found->second);
}

// Tries the next step on the slider, after the last step the first. Waits before it tries the first step again.
void ViewServer::tell_facts_of_another(ViewerId id, Viewer& viewer, std::size_t unreadable) {
  viewer.wanted = steps_.after(unreadable).value_or(steps_.order().front());
  if (viewer.wanted != first_step()) return tell_facts(id, viewer);
  viewer.retry.emplace(io_, settings_.look_again);
  viewer.retry->async_wait([this, id, alive = std::weak_ptr(alive_)](const boost::system::error_code& error) {
    if (error || !alive.lock()) return;
    const auto found = viewers_.find(id);
    if (found != viewers_.end()) tell_facts(id, found->second);
  });
}

// Returns the values that a page shows of the file; for a series, what its steps have in common. Any thread may ask.
SeenValues ViewServer::values_of(const std::string& path, const SeenValues& common) {
  if (files_.series()) return common;
  const auto file = open_files_.get(path);
  return seen_values(*file, [&] { return cameras_.cells_of(file); });
}

std::string ViewServer::count_histogram(const HistogramQuestion& question, const std::atomic<bool>& cancel) {
  Json histogram{{"type", "histogram"}, {"step", question.step}, {"side", question.side}};
  histogram.update(histogram_facts(*open_files_.get(question.path), cancel));
  return line(histogram);
}

std::vector<int> ViewServer::sides() const { return files_.against.empty() ? std::vector{0} : std::vector{0, 1}; }

void ViewServer::answer_probe(ViewerId id, Viewer& viewer) {
  if (!viewer.probe || !viewer.view) return;
  const ProbeRequest probe = *std::exchange(viewer.probe, std::nullopt);
  viewer.probing = true;
  boost::asio::post(
      side_, [this, id, probe, view = viewer.view, common = common_values(), alive = std::weak_ptr(alive_)] {
        Json answer{{"type", "value"}, {"id", probe.id}, {"found", false}};
        try {
          const auto file = open_files_.get(file_of(view->step, probe.side));
          RenderOptions picture;
          picture.width = view->width;
          picture.height = view->height;
          picture.background = picture_background(files_);
          const GridFrame first = frame_of(open_files_.get(file_of(view->step, 0))->grid());
          const std::optional<Scene> scene = scene_of_other(view->scene, first, frame_of(file->grid()));
          const SeenValues values = values_of(file_of(view->step, probe.side), common);
          if (const auto found = !scene ? std::nullopt
                                        : probe_voxel(file->grid(), *scene, cameras_.camera(file, *scene, picture),
                                                      values.range, values.background, probe.x, probe.y)) {
            answer["found"] = true;
            answer["value"] = found->value;
            answer["voxel"] = {found->voxel.x, found->voxel.y, found->voxel.z};
            answer["world"] = found->world;
            if (view->against) {
              const auto other = open_files_.get(file_of(view->step, 1 - probe.side));
              const std::optional<float> there = value_at(other->grid(), found->world);
              answer["against"] = there ? Json(*there) : Json();
              answer["outside"] = !there;
            }
          }
        } catch (const std::exception& error) {
          answer["message"] = error.what();
        }
        boost::asio::post(io_, [this, id, alive, text = line(answer)] {
          if (!alive.lock()) return;
          const auto found = viewers_.find(id);
          if (found == viewers_.end()) return;
          const auto socket = found->second.socket;
          found->second.probing = false;
          answer_probe(id, found->second);
          socket->send_text(text);  // last: a viewer that reads nothing is removed by this call
        });
      });
}

void ViewServer::handle(ViewerId id, Viewer& viewer, const ConvertRequest& request) {
  const std::size_t step = request.step ? *request.step : viewer.view ? viewer.view->step : 0;
  scene_requests_.handle(id, step, file_of(step, 0), request);
}

RenderEvents ViewServer::render_events() {
  const auto alive = std::weak_ptr(alive_);
  return {[this, alive](ViewerId id, const FrameHeader& header, const std::vector<std::byte>& picture) {
            boost::asio::post(io_, [this, alive, id, message = frame_message(header, picture)]() mutable {
              if (!alive.lock()) return;
              const auto found = viewers_.find(id);
              if (found != viewers_.end()) found->second.socket->send_picture(std::move(message));
            });
          },
          [this, alive](ViewerId id, std::int64_t view, std::string_view what, double share) {
            const Json message{{"type", "progress"}, {"view", view}, {"what", what}, {"share", share}};
            boost::asio::post(io_, [this, alive, id, text = line(message)] {
              if (alive.lock()) send(id, text);
            });
          },
          [this, alive](ViewerId id, std::int64_t view, const std::string& message) {
            boost::asio::post(io_, [this, alive, id, text = error_message(view, message)] {
              if (alive.lock()) send(id, text);
            });
          }};
}

}  // namespace weir
