// The server of `weir view`: the page at /, the page's requests at /api/state, and a WebSocket for each viewer at /ws.
// All viewers share the volumes, the render thread and the threads that look values up. Lives on the io_context's
// thread.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/listen_address.h"
#include "daemon/http/access.h"
#include "daemon/http/http_server.h"
#include "gpu/render/backend.h"
#include "tools/view/base/open_files.h"
#include "tools/view/convert/scene_requests.h"
#include "tools/view/histogram_counts.h"
#include "tools/view/kept_texts.h"
#include "tools/view/picture_cameras.h"
#include "tools/view/render_loop.h"
#include "tools/view/steps/step_list.h"
#include "tools/view/steps/step_watch.h"
#include "tools/view/steps/viewed_files.h"
#include "tools/view/viewer_socket.h"
#include "tools/view/volume_facts.h"

namespace weir {

struct ViewSettings {
  ListenAddress address{"127.0.0.1", 0};
  std::string token;                               ///< token that every viewer must send; empty: none, loopback only
  std::size_t viewers = 8;                         ///< most viewers at once
  std::int64_t pixels = kMostViewPixels;           ///< most pixels of a picture
  bool allow_convert = false;                      ///< a viewer may have the source converted
  bool forecast = true;                            ///< a viewer may have a conversion forecast
  std::vector<std::string> forecast_options = {};  ///< options of weir convert for a forecast, "--memory=N" for
                                                   ///< instance
  std::string program;                             ///< path of weir, for conversion and forecast
  std::string version;                             ///< version of weir, shown on the page
  std::string preview_of = {};    ///< source of which the file is a preview, shown on the page; empty: none
  std::string render_input = {};  ///< shell words behind "weir render" that draw that source; empty: none
  bool any_host = false;          ///< any Host header is accepted: the client has a token that no web page can know
  std::chrono::milliseconds look_again{1000};  ///< time between two looks for new steps of a growing series
  HttpLimits http = {};
  ViewerLimits sockets = {};
};

class ViewServer {
 public:
  /// Starts to listen. `backend` must outlive the server. Throws Error(usage) for an address that others can reach
  /// without a token, Error(io) if the address cannot be bound.
  ViewServer(boost::asio::io_context& io, ViewSettings settings, ViewedFiles files, Backend& backend);
  /// Waits for the pass and the look-up that are under way.
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  std::uint16_t port() const { return http_->port(); }
  std::size_t viewers() const { return viewers_.size(); }

 private:
  struct Viewer {
    std::shared_ptr<ViewerSocket> socket;
    std::shared_ptr<const ViewRequest> view;
    std::optional<ProbeRequest> probe;  // newest probe, waiting until the current probe is answered
    bool probing = false;
    std::optional<std::size_t> told;    // the step whose facts were sent or are being made
    std::string told_of;                // told_file() of `told`
    std::optional<std::size_t> wanted;  // the step whose facts are sent next
    bool telling = false;
    std::optional<boost::asio::steady_timer> retry;  // waits before `wanted` is tried again, if no step could be read
  };
  struct Facts {
    std::vector<std::string> texts;  // one text per side
    bool readable = true;            // the step's own file can be read
  };

  HttpResponse answer(const HttpRequest& request) const;
  HttpResponse route(const HttpRequest& request) const;
  std::optional<HttpResponse> refuse_viewer(const HttpRequest& request) const;
  void add_viewer(ViewerSocket::Socket socket, const UpgradeRequest& request);
  void remove_viewer(ViewerId id);
  void receive(ViewerId id, std::string_view text);
  void handle(ViewerId id, Viewer& viewer, ViewRequest view);
  void handle(ViewerId id, Viewer& viewer, const ShownMessage& shown);
  void handle(ViewerId id, Viewer& viewer, const ProbeRequest& probe);
  void handle(ViewerId id, Viewer& viewer, const ConvertRequest& request);
  void tell_facts(ViewerId id, Viewer& viewer);
  void tell_facts(ViewerId id, std::size_t step, const SeenValues& common, const Facts& facts);
  void tell_facts_of_another(ViewerId id, Viewer& viewer, std::size_t unreadable);
  SeenValues values_of(const std::string& path, const SeenValues& common);
  std::string count_histogram(const HistogramQuestion& question, const std::atomic<bool>& cancel);
  std::vector<int> sides() const;
  void answer_probe(ViewerId id, Viewer& viewer);
  void send(ViewerId id, std::string text);
  RenderEvents render_events();
  std::string file_of(std::size_t step, int side) const;
  std::string name_of(std::size_t step, int side) const;
  std::string told_file(std::size_t step) const;
  std::size_t first_step() const;
  SeenValues common_values() const { return seen_values(summary_); }
  void tell_steps(const SeriesSummary& summary);

  boost::asio::io_context& io_;
  const ViewSettings settings_;
  const ViewedFiles files_;  // the files at the start
  const std::vector<std::string> against_names_ = step_names(files_.against);
  SeriesSummary summary_;  // of all steps seen so far
  StepList steps_;
  const AccessRules rules_;
  std::string state_text_;  // of /api/state, without what changes
  Backend& backend_;
  std::map<ViewerId, Viewer> viewers_;
  ViewerId last_id_ = 0;
  std::shared_ptr<int> alive_ = std::make_shared<int>(0);  // work posted by other threads is dropped when this is gone
  OpenFiles open_files_;
  KeptTexts facts_cache_;
  PictureCameras cameras_;
  VolumeShelf shelf_;
  std::optional<HistogramCounts> histograms_;
  std::optional<RenderLoop> loop_;
  SceneRequests scene_requests_;
  boost::asio::thread_pool side_{2};  // looks up facts and values, looks for steps
  std::optional<StepWatch> step_watch_;
  std::unique_ptr<HttpServer> http_;
};

}  // namespace weir
