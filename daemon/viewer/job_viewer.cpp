#include "daemon/viewer/job_viewer.h"

#include <algorithm>
#include <boost/beast/websocket/rfc6455.hpp>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "daemon/config/listen_address.h"
#include "daemon/http/timer.h"
#include "daemon/http/view_requests.h"
#include "daemon/jobs/worker_reason.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/numbered_series.h"

namespace weir {
namespace {

using boost::system::error_code;

constexpr std::uint64_t kViewers = 4;  // viewing pages at the same time

// How a viewer's memory is divided. Forecasts of conversions, a separate process, get a share if there is enough. Of
// the rest, the program takes kProgramBytes, and pictures and voxels get half each. One viewer's picture takes
// kDrawnPixelBytes per pixel while it is drawn and encoded, one viewer at a time; the pictures of the others wait as
// sums and PNG and take kWaitingPixelBytes. Measured: docs/limits.md.
constexpr std::uint64_t kProgramBytes = std::uint64_t{16} << 20;
constexpr std::uint64_t kDrawnPixelBytes = 34;
constexpr std::uint64_t kWaitingPixelBytes = 28;
constexpr std::uint64_t kMostPixels = std::uint64_t{4} << 20;  // the most that weir view accepts

struct ViewerShares {
  std::uint64_t forecast_bytes;  ///< 0: no forecasts
  std::uint64_t voxel_bytes;
  std::uint64_t pixels;  ///< pixels of a picture
};

ViewerShares shares_of(std::uint64_t memory) {
  const std::uint64_t forecast =
      memory < kForecastingViewerMemory ? 0 : std::max(kForecastingViewerMemory - kLeastViewerMemory, memory / 4);
  const std::uint64_t drawing = memory - forecast;
  const std::uint64_t half = (drawing - std::min(drawing, kProgramBytes)) / 2;
  return {forecast, half, std::min(kMostPixels, half / (kDrawnPixelBytes + (kViewers - 1) * kWaitingPixelBytes))};
}

}  // namespace

JobViewer::JobViewer(boost::asio::io_context& io, const EventLog& log, std::string program, JobViewerTimes times)
    : io_(io), log_(log), program_(std::move(program)), times_(times), wait_(io), look_(io) {}

void JobViewer::configure(const ServiceConfig& service) {
  const ServiceConfig before = std::exchange(service_, service);
  const bool same = before.viewer_memory == service.viewer_memory && before.threads == service.threads &&
                    before.nice == service.nice && before.io_class == service.io_class &&
                    before.bandwidth == service.bandwidth && before.work_dir == service.work_dir;
  if (!same && worker_) {
    stop();
    log_.info("viewer-ended", {{"file", file_}, {"reason", "the configuration is another"}});
  }
}

JobViewer::Opened JobViewer::open(const std::string& file, bool force) {
  if (over_ || service_.viewer_memory == 0) return Opened::off;
  if (worker_ && series_key(file) == series_key(file_)) {
    if (state_ == ViewerState::ready) await_page();
    return Opened::made;
  }
  if (taken() && !force) return Opened::taken;
  start(file);
  return Opened::made;
}

// Ends the old viewer first, so that its memory is free before the new one takes any.
void JobViewer::start(const std::string& file) {
  stop();
  file_ = file;
  const ViewerShares shares = shares_of(service_.viewer_memory);
  WorkerCommand command{
      program_,
      {"weir", "view", file, "--series", "--private", cat("--progress-fd=", kAnnounceDescriptor), "--progress=never",
       "--backend=cpu", cat("--memory=", shares.voxel_bytes), cat("--forecast-memory=", shares.forecast_bytes),
       cat("--pixels=", shares.pixels), cat("--viewers=", kViewers), cat("--threads=", service_.threads)},
      service_.nice,
      service_.io_class};
  if (service_.bandwidth != 0) command.arguments.push_back(cat("--forecast-bandwidth=", service_.bandwidth));
  if (!service_.work_dir.empty()) command.arguments.push_back(cat("--work-dir=", service_.work_dir));
  try {
    worker_ = std::make_unique<WorkerProcess>(
        io_, command, [this](std::string_view line) { heard(line); }, [this](const WorkerEnd& end) { ended(end); });
  } catch (const Error& error) {
    fail(error.what());
    return;
  }
  state_ = ViewerState::starting;
  log_.info("viewer", {{"file", file}});
  wait_.expires_after(times_.start);
  wait_.async_wait([this](error_code error) {
    if (!error && state_ == ViewerState::starting && is_over(wait_))
      fail(cat("the viewer did not answer within ", times_.start.count() / 1000, " s"));
  });
  look_at_memory();
}

void JobViewer::heard(std::string_view line) {
  if (state_ != ViewerState::starting) return;
  try {
    const nlohmann::json told = nlohmann::json::parse(line);
    const ListenAddress address = parse_listen_address(told.at("address").get<std::string>());
    token_ = told.at("token").get<std::string>();
    address_ = {boost::asio::ip::make_address(address.host), address.port};
  } catch (const std::exception&) {  // a line about progress, which does not matter here
    return;
  }
  state_ = ViewerState::ready;
  await_page();
}

void JobViewer::await_page() {
  awaited_until_ = std::chrono::steady_clock::now() + times_.open;
  end_when_idle();
}

void JobViewer::ended(const WorkerEnd& end) { fail(worker_reason("view", end)); }

void JobViewer::fail(const std::string& reason) {
  stop();
  state_ = ViewerState::failed;
  reason_ = reason;
  log_.error("viewer-failed", {{"file", file_}, {"reason", reason}});
}

void JobViewer::stop() {
  worker_.reset();
  wait_.cancel();
  look_.cancel();
  for (const Connection& connection : std::exchange(connections_, {})) connection.relay->close();
  state_ = ViewerState::none;
  reason_.clear();
  token_.clear();
}

std::size_t JobViewer::sockets() const {
  return static_cast<std::size_t>(
      std::count_if(connections_.begin(), connections_.end(), [](const Connection& c) { return c.looks; }));
}

bool JobViewer::looked_at() const { return sockets() > 0; }

// Returns whether somebody uses the viewer or waits for it: a requester keeps it until the page connects.
bool JobViewer::taken() const {
  return state_ == ViewerState::starting || looked_at() ||
         (state_ == ViewerState::ready && std::chrono::steady_clock::now() < awaited_until_);
}

void JobViewer::end() {
  over_ = true;
  stop();
}

// Ends the viewer after the idle time unless somebody looks again. Connections for files of the page do not keep it
// alive.
void JobViewer::end_when_idle() {
  wait_.cancel();
  if (looked_at()) return;
  wait_.expires_after(times_.idle);
  wait_.async_wait([this](error_code error) {
    if (error || state_ != ViewerState::ready || !is_over(wait_) || looked_at()) return;
    stop();
    log_.info("viewer-ended", {{"file", file_}, {"reason", "nobody was connected"}});
  });
}

void JobViewer::look_at_memory() {
  look_.expires_after(times_.look);
  look_.async_wait([this](error_code error) {
    if (error || !worker_) return;
    const std::uint64_t bytes = worker_->anonymous_bytes();
    const std::uint64_t forecast = shares_of(service_.viewer_memory).forecast_bytes;
    if (bytes <= service_.viewer_memory - forecast) return look_at_memory();
    const std::string aside = forecast == 0 ? "" : cat(" less ", format_bytes(forecast), " for forecasts");
    fail(cat("the viewer took ", format_bytes(bytes), ", more than viewer_memory = ",
             format_bytes(service_.viewer_memory), aside, "; raise that, or make the window smaller"));
  });
}

void JobViewer::relay(Relay::Client client, const UpgradeRequest& request) {
  if (state_ != ViewerState::ready) return;  // the viewer ended a moment ago; the client asks again
  const bool looks = boost::beast::websocket::is_upgrade(request);
  if (!looks) make_room_for_a_file();
  const auto relay = std::make_shared<Relay>(std::move(client), forwarded_request(request, token_),
                                             [this](Relay& over) { remove(over); });
  connections_.push_back({relay, looks});
  if (looks) {
    wait_.cancel();
    awaited_until_ = {};
  }
  relay->start(address_, looks ? std::nullopt : std::optional(times_.page));
}

// Closes the oldest connection for a page file if there are too many, so that slow clients keep nobody else from
// them.
void JobViewer::make_room_for_a_file() {
  if (connections_.size() - sockets() < kMostViewerFiles) return;
  const auto oldest =
      std::find_if(connections_.begin(), connections_.end(), [](const Connection& c) { return !c.looks; });
  oldest->relay->close();
  connections_.erase(oldest);
}

void JobViewer::remove(const Relay& relay) {
  const bool looked = looked_at();
  std::erase_if(connections_, [&](const Connection& connection) { return connection.relay.get() == &relay; });
  if (looked && state_ == ViewerState::ready) end_when_idle();
}

ViewerView JobViewer::view() const {
  ViewerView view;
  view.memory_bytes = service_.viewer_memory;
  if (over_ || service_.viewer_memory == 0) {
    view.state = ViewerState::off;
    const char* const off = service_.is_standard_viewer ? "no viewer: " : "viewers are off: ";
    view.reason = over_ ? "the service is stopping" : off + no_viewer_reason(service_);
    return view;
  }
  view.state = state_;
  view.reason = reason_;
  view.file = state_ == ViewerState::none ? "" : file_;
  view.connections = connections_.size();
  view.sockets = sockets();
  view.rss_bytes = worker_ ? worker_->resident_bytes() : 0;
  return view;
}

}  // namespace weir
