#include "daemon/http/api.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "daemon/http/api_json.h"
#include "daemon/http/metrics.h"
#include "daemon/http/page_files.h"
#include "daemon/http/page_response.h"
#include "daemon/http/request_target.h"
#include "daemon/jobs/thumbnail_file.h"
#include "format/base/text.h"
#include "ingest/files/numbered_series.h"

namespace weir {
namespace {

// What a route's function receives: the request's target and the context.
struct Call {
  Control& control;
  const RequestTarget& target;
  bool trusted;                   ///< may see data
  const std::string& control_at;  ///< AccessRules::control_at
};

struct Route {
  std::string_view method;
  std::string_view path;  ///< "*" stands for any one segment
  bool open;              ///< needs no token
  HttpResponse (*answer)(const Call&);
  const char* parameters =
      nullptr;  ///< all parameters that the route accepts, separated by commas; null: unknown ones are ignored
};

HttpResponse ok(const OrderedJson& json) {
  HttpResponse response;
  response.body = json_line(json);
  return response;
}

HttpResponse text(unsigned status, std::string body, std::string type = "text/plain; charset=utf-8") {
  return {status, std::move(type), std::move(body), {}};
}

HttpResponse no_such_job(const std::string& id) { return error_response(404, cat("there is no job ", id)); }

std::optional<std::int64_t> job_id(const Call& call) { return parse_int(call.target.path[2]); }

HttpResponse page_file(const Call& call) {
  return page_response({page_files()}, call.target.path.empty() ? "index.html" : call.target.path[1]);
}

HttpResponse health(const Call& /*call*/) { return text(200, "ok\n"); }

HttpResponse ready(const Call& call) {
  const Readiness readiness = call.control.readiness();
  if (readiness.ready) return text(200, "ready\n");
  return text(503, call.trusted ? cat("not ready: ", readiness.reason, '\n') : "not ready\n");
}

HttpResponse metrics(const Call& call) {
  return text(200, metrics_text(call.control.status(), call.control.metrics(), process_usage()),
              "text/plain; version=0.0.4; charset=utf-8");
}

HttpResponse status(const Call& call) {
  OrderedJson json = to_json(call.control.status());
  json["control_at"] = call.control_at.empty() ? OrderedJson() : OrderedJson(call.control_at);
  return ok(json);
}

// Sets `value` from the parameter `name` if it is given. Returns whether the parameter is valid.
bool read_count(const RequestTarget& target, const std::string& name, std::size_t max, std::size_t& value) {
  const auto found = target.query.find(name);
  if (found == target.query.end()) return true;
  const auto number = parse_int(found->second);
  if (!number || *number < 0 || static_cast<std::uint64_t>(*number) > max) return false;
  value = static_cast<std::size_t>(*number);
  return true;
}

HttpResponse bad_limit(const RequestTarget& target) {
  return error_response(400, cat("limit=", target.query.at("limit"), ": give 0 to ", kMaxJobsPerPage));
}

// Sets `order` from the parameters sort and order if they are given. Returns whether they are valid.
bool read_order(const RequestTarget& target, std::optional<JobOrder>& order) {
  const auto sort = target.query.find("sort");
  const auto way = target.query.find("order");
  if (sort == target.query.end() && way == target.query.end()) return true;
  order.emplace();
  if (sort != target.query.end()) {
    const auto key = std::find(kJobOrderKeys.begin(), kJobOrderKeys.end(), sort->second);
    if (key == kJobOrderKeys.end()) return false;
    order->key = static_cast<JobOrderKey>(key - kJobOrderKeys.begin());
  }
  if (way == target.query.end()) return true;
  order->descending = way->second == "desc";
  return order->descending || way->second == "asc";
}

HttpResponse jobs(const Call& call) {
  JobQuery query;
  for (const auto& [name, value] : call.target.query) {
    if (name == "watch") {
      query.watch = value;
    } else if (name == "text") {
      query.text = value;
    } else if (name == "problem") {
      query.problem = value;
    } else if (name == "state") {
      query.state = parse_job_state(value);
      if (!query.state) {
        return error_response(400, cat("state=", value,
                                       ": jobs are discovered, waiting, running, done, failed, "
                                       "quarantined or cancelled"));
      }
    }
  }
  if (!read_order(call.target, query.order)) {
    std::string keys;
    for (const std::string_view key : kJobOrderKeys) keys += cat(keys.empty() ? "" : ", ", key);
    return error_response(400, cat("sort is one of ", keys, "; order is asc or desc"));
  }
  if (!read_count(call.target, "limit", kMaxJobsPerPage, query.limit)) return bad_limit(call.target);
  if (!read_count(call.target, "offset", std::size_t{1} << 53, query.offset)) {
    return error_response(400, cat("offset=", call.target.query.at("offset"), ": give 0 or more"));
  }
  return ok(to_json(call.control.jobs(query), query));
}

HttpResponse problems(const Call& call) {
  std::size_t limit = JobQuery{}.limit;
  if (!read_count(call.target, "limit", kMaxJobsPerPage, limit)) return bad_limit(call.target);
  return ok(to_json(call.control.problems(limit)));
}

HttpResponse job(const Call& call) {
  const auto id = job_id(call);
  const auto found = id ? call.control.job(*id) : std::nullopt;
  return found ? ok(to_json(*found)) : no_such_job(call.target.path[2]);
}

HttpResponse thumbnail(const Call& call) {
  const auto id = job_id(call);
  if (!id) return no_such_job(call.target.path[2]);
  const std::string& place = call.target.path[4];
  const auto output = parse_int(place);
  const auto path =
      output && *output >= 0 ? call.control.thumbnail_path(*id, static_cast<std::size_t>(*output)) : std::nullopt;
  auto image = path ? read_thumbnail(*path) : std::nullopt;
  if (!image) return error_response(404, cat("job ", *id, " has no thumbnail ", place));
  HttpResponse response = text(200, std::move(*image), "image/png");
  // A long cache time is safe, because the page adds the time of the job's last change to the address.
  response.headers.emplace_back("Cache-Control", "private, max-age=86400");
  return response;
}

template <typename Make>
HttpResponse change(const Call& call, const Make& make) {
  const std::string& action = call.target.path[3];
  const auto id = job_id(call);
  const JobChange made = id ? make(*id) : JobChange::no_such_job;
  const auto now = made == JobChange::no_such_job ? std::nullopt : call.control.job(*id);
  if (!now) return no_such_job(call.target.path[2]);
  if (made == JobChange::wrong_state) {
    return error_response(409, cat("job ", *id, " is ", job_state_name(now->state), ": nothing to ", action));
  }
  if (made == JobChange::no_source) {
    return error_response(409, cat("job ", *id, " is done, and its source is gone: nothing to ", action));
  }
  return ok(to_json(*now));
}

HttpResponse retry(const Call& call) {
  const auto force = call.target.query.find("force");
  if (force != call.target.query.end() && force->second != "1") {
    return error_response(400, cat("force=", force->second, ": give force=1, or leave it out"));
  }
  return change(call, [&](std::int64_t id) { return call.control.retry(id, force != call.target.query.end()); });
}

HttpResponse viewer(const Call& call) { return ok(to_json(call.control.viewer())); }

// Returns the address of the viewer's page for this file. It names the page's series, and the job that opens the
// series again.
std::string view_address(const std::string& path, std::int64_t job, std::size_t output) {
  return cat("/view/?series=", series_digest(path), "&job=", job, "&output=", output,
             "#f=", percent_encode(path.substr(path.rfind('/') + 1)));
}

HttpResponse view(const Call& call) {
  std::size_t output = 0;
  const auto force = call.target.query.find("force");
  if (!read_count(call.target, "output", kMaxJobsPerPage, output) ||
      (force != call.target.query.end() && force->second != "1")) {
    return error_response(400, "give output=N, the place of an output from 0 on, and force=1, or leave them out");
  }
  const auto id = job_id(call);
  const auto job = id ? call.control.job(*id) : std::nullopt;
  if (!job) return no_such_job(call.target.path[2]);
  const ViewChange change = call.control.view(*id, output, force != call.target.query.end());
  OrderedJson json = to_json(call.control.viewer());
  switch (change) {
    case ViewChange::made:
      json["url"] = view_address(job->outputs.at(output).path, *id, output);
      return ok(json);
    case ViewChange::wrong_state:
      return error_response(409, cat("job ", *id, " is ", job_state_name(job->state), ": nothing to view"));
    case ViewChange::off:
      return error_response(409, json["reason"]);
    case ViewChange::taken:
      return error_response(423, cat("somebody looks at ", json["file"].get<std::string>(), ", or opens it",
                                     "; wait until that page is closed, or take the viewer with force=1"));
    case ViewChange::no_such_job:
    case ViewChange::no_such_output:
      break;
  }
  return error_response(404, cat("job ", *id, " has no output ", output));
}

HttpResponse cancel(const Call& call) {
  return change(call, [&](std::int64_t id) { return call.control.cancel(id); });
}

HttpResponse retry_failed(const Call& call) {
  const auto problem = call.target.query.find("problem");
  if (problem == call.target.query.end()) return ok({{"retried", call.control.retry_all_failed("")}});
  if (problem->second.empty()) {
    return error_response(400, "problem=: give problem=KEY as /api/problems says it, or leave it out");
  }
  return ok({{"retried", call.control.retry_all_failed(problem->second)}});
}

HttpResponse pause(const Call& call) {
  call.control.pause();
  return status(call);
}

HttpResponse resume(const Call& call) {
  call.control.resume();
  return status(call);
}

constexpr std::array kRoutes = {
    Route{"GET", "/", true, page_file},
    Route{"GET", "/page/*", true, page_file},
    Route{"GET", "/healthz", true, health},
    Route{"GET", "/readyz", true, ready},
    Route{"GET", "/metrics", false, metrics},
    Route{"GET", "/api/status", false, status},
    Route{"GET", "/api/jobs", false, jobs, "state,watch,text,problem,sort,order,limit,offset"},
    Route{"GET", "/api/problems", false, problems},
    Route{"GET", "/api/jobs/*", false, job},
    Route{"GET", "/api/jobs/*/thumbnails/*", false, thumbnail},
    Route{"GET", "/api/viewer", false, viewer},
    Route{"POST", "/api/jobs/*/view", false, view, "output,force"},
    Route{"POST", "/api/jobs/*/retry", false, retry, "force"},
    Route{"POST", "/api/jobs/*/cancel", false, cancel, ""},
    Route{"POST", "/api/retry-failed", false, retry_failed, "problem"},
    Route{"POST", "/api/pause", false, pause, ""},
    Route{"POST", "/api/resume", false, resume, ""},
};

bool matches(std::string_view pattern, const std::vector<std::string>& path) {
  if (path.empty()) return pattern == "/";
  const std::vector<std::string> wanted = split(pattern.substr(1), '/');
  return std::equal(wanted.begin(), wanted.end(), path.begin(), path.end(),
                    [](const std::string& w, const std::string& p) { return w == "*" ? !p.empty() : w == p; });
}

// Returns "there are sort, order and limit", "there is force" or "there is none".
std::string names_text(const std::vector<std::string>& names) {
  if (names.empty()) return "there is none";
  std::string text = cat(names.size() == 1 ? "there is " : "there are ", names.front());
  for (std::size_t i = 1; i < names.size(); ++i) text += cat(i + 1 == names.size() ? " and " : ", ", names[i]);
  return text;
}

// Refuses unknown parameters: a misspelt one would ask for something else than was meant.
std::optional<HttpResponse> refuse_parameters(const Route& route, const RequestTarget& target) {
  if (route.parameters == nullptr) return std::nullopt;
  std::vector<std::string> known = split(route.parameters, ',');
  std::erase(known, "");
  for (const auto& [name, value] : target.query) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    return error_response(400, cat("unknown parameter ", name, "; ", names_text(known)));
  }
  return std::nullopt;
}

HttpResponse answer_routed(Control& control, const AccessRules& rules, const HttpRequest& request) {
  const auto target = parse_target(request.target);
  const std::string_view method = request.method == "HEAD" ? "GET" : std::string_view(request.method);
  const Route* chosen = nullptr;
  std::string allowed;
  if (target) {
    for (const Route& route : kRoutes) {
      if (!matches(route.path, target->path)) continue;
      if (route.method == method) chosen = &route;
      allowed = route.method == "GET" ? "GET, HEAD" : std::string(route.method);
    }
  }
  if (auto refused = refuse(rules, request, chosen != nullptr && chosen->open)) return *std::move(refused);
  if (!target) return error_response(400, "the request's target is no path with parameters, each given once");
  if (chosen != nullptr) {
    if (auto refused = refuse_parameters(*chosen, *target)) return *std::move(refused);
    return chosen->answer({control, *target, !refuse(rules, request, false), rules.control_at});
  }
  if (allowed.empty()) return error_response(404, cat("there is nothing at ", request.target));
  HttpResponse response = error_response(405, cat(request.method, " is not for ", request.target, "; use ", allowed));
  response.headers.emplace_back("Allow", allowed);
  return response;
}

}  // namespace

std::vector<std::string> api_routes() {
  std::vector<std::string> routes;
  for (const Route& route : kRoutes) routes.push_back(cat(route.method, ' ', route.path));
  return routes;
}

HttpResponse Api::answer(const HttpRequest& request) const {
  HttpResponse response = answer_routed(control_, rules_, request);
  add_page_headers(response);
  return response;
}

}  // namespace weir
