#include "daemon/http/api.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "format/base/text.h"
#include "tests/daemon/support/fake_control.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::api_test {
namespace {

using Json = nlohmann::json;

class ApiTest : public testing::Test {
 protected:
  ApiTest() {
    constexpr std::array kStates = {JobState::done, JobState::done, JobState::failed, JobState::waiting,
                                    JobState::running};
    for (std::size_t i = 0; i < kStates.size(); ++i) {
      JobView job;
      job.id = static_cast<std::int64_t>(i) + 1;
      job.watch = i % 2 == 0 ? "/scratch/run 1" : "/scratch/run 2";
      job.source = cat("/scratch/", job.id, ".raw");
      job.state = kStates[i];
      job.log_tail = "line\n";
      control_.all.push_back(job);
    }
    control_.now.state = "running";
  }

  HttpResponse ask(const std::string& method, const std::string& target) {
    HttpRequest request;
    request.method = method;
    request.target = target;
    request.host = "localhost:8470";
    request.marked = true;
    return api_.answer(request);
  }
  Json get(const std::string& target) { return Json::parse(ask("GET", target).body); }
  std::vector<int> ids(const std::string& query) {
    const Json answer = get("/api/jobs" + query);
    std::vector<int> found;
    for (const Json& job : answer.at("jobs")) found.push_back(job.at("id"));
    return found;
  }

  FakeControl control_;
  Api api_{control_, {}};
};

std::string header(const HttpResponse& response, const std::string& name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) return value;
  }
  return "";
}

TEST_F(ApiTest, ReportsHealthAndReadiness) {
  EXPECT_EQ(ask("GET", "/healthz").status, 200U);
  EXPECT_EQ(ask("GET", "/healthz").body, "ok\n");
  EXPECT_EQ(ask("GET", "/readyz").body, "ready\n");
  control_.readiness_now = {false, "/scratch/run: not there"};
  EXPECT_EQ(ask("GET", "/readyz").status, 503U);
  EXPECT_EQ(ask("GET", "/readyz").body, "not ready: /scratch/run: not there\n");
  EXPECT_EQ(ask("GET", "/healthz").status, 200U);
}

TEST_F(ApiTest, ShowsMetrics) {
  const HttpResponse response = ask("GET", "/metrics");
  EXPECT_EQ(response.content_type, "text/plain; version=0.0.4; charset=utf-8");
  EXPECT_NE(response.body.find("\nweir_jobs{state=\"done\"} 2\n"), std::string::npos);
}

TEST_F(ApiTest, ListsJobs) {
  EXPECT_EQ(ids(""), (std::vector{1, 2, 3, 4, 5}));
  EXPECT_EQ(ids("?state=done"), (std::vector{1, 2}));
  EXPECT_EQ(ids("?watch=%2Fscratch%2Frun+2"), (std::vector{2, 4}));
  EXPECT_EQ(ids("?watch=/scratch/run%201&state=failed"), (std::vector{3}));
  EXPECT_EQ(ids("?limit=2&offset=1"), (std::vector{2, 3}));
  EXPECT_EQ(ids("?limit=0"), (std::vector<int>{}));
  EXPECT_EQ(ids("?offset=9"), (std::vector<int>{}));
  const Json page = get("/api/jobs?limit=2&offset=1");
  EXPECT_EQ(page.at("total"), 5);
  EXPECT_EQ(page.at("limit"), 2);
  EXPECT_EQ(page.at("offset"), 1);
}

TEST_F(ApiTest, RefusesWrongParameters) {
  const auto error = [&](const std::string& query) {
    const HttpResponse response = ask("GET", "/api/jobs?" + query);
    EXPECT_EQ(response.status, 400U) << query;
    return Json::parse(response.body).at("error").get<std::string>();
  };
  EXPECT_EQ(error("state=broken"),
            "state=broken: jobs are discovered, waiting, running, done, failed, quarantined or cancelled");
  EXPECT_EQ(error("limit=1001"), "limit=1001: give 0 to 1000");
  EXPECT_EQ(error("limit=-1"), "limit=-1: give 0 to 1000");
  EXPECT_EQ(error("limit="), "limit=: give 0 to 1000");
  EXPECT_EQ(error("offset=1e3"), "offset=1e3: give 0 or more");
  EXPECT_EQ(error("offset=99999999999999999999"), "offset=99999999999999999999: give 0 or more");
  EXPECT_EQ(error("page=2"),
            "unknown parameter page; there are state, watch, text, problem, sort, order, limit and offset");
}

TEST_F(ApiTest, PostWithAParameterThatItDoesNotHave_ChangesNothing) {
  const auto error = [&](const std::string& target) {
    const HttpResponse response = ask("POST", target);
    EXPECT_EQ(response.status, 400U) << target;
    return Json::parse(response.body).at("error").get<std::string>();
  };
  EXPECT_EQ(error("/api/jobs/3/retry?forse=1"), "unknown parameter forse; there is force");
  EXPECT_EQ(error("/api/jobs/4/cancel?force=1"), "unknown parameter force; there is none");
  EXPECT_EQ(error("/api/jobs/1/view?outputs=1"), "unknown parameter outputs; there are output and force");
  EXPECT_EQ(error("/api/retry-failed?problems=x"), "unknown parameter problems; there is problem");
  EXPECT_EQ(error("/api/pause?s=60"), "unknown parameter s; there is none");
  EXPECT_EQ(error("/api/resume?s=60"), "unknown parameter s; there is none");
  EXPECT_EQ(control_.asked, std::vector<std::string>{});
  EXPECT_EQ(ask("GET", "/api/status?_=1").status, 200U) << "as some clients add against caches";
}

TEST_F(ApiTest, ShowsEveryFieldOfAJob) {
  JobView& job = control_.all[0];
  job.source_bytes = 1 << 20;
  job.attempts = 2;
  job.discovered_at = 1795253270.125;
  job.changed_at = 1795253271;
  job.reason = "said \"no\"";
  job.exit_code = 3;
  job.seconds = 1.5;
  job.bytes_read = 10;
  job.bytes_written = 11;
  job.peak_rss_bytes = 12;
  job.outputs.push_back({"/out/\xff.nvdb", 1000, 8, 40.5, false, true, 0.25, -1, 3.5});
  job.outputs.push_back({"/out/b.nvdb", 2000, 4, {}, true, false});
  EXPECT_EQ(ask("GET", "/api/jobs/1").body,
            "{\"id\":1,\"watch\":\"/scratch/run 1\",\"source\":\"/scratch/1.raw\",\"state\":\"done\","
            "\"source_bytes\":1048576,\"attempts\":2,\"discovered_at\":1795253270.125,\"changed_at\":1795253271.0,"
            "\"next_attempt_at\":null,\"reason\":\"said \\\"no\\\"\",\"exit_code\":3,\"seconds\":1.5,"
            "\"bytes_read\":10,\"bytes_written\":11,\"peak_rss_bytes\":12,\"outputs\":["
            "{\"path\":\"/out/\xef\xbf\xbd.nvdb\",\"bytes\":1000,\"rate\":8.0,\"psnr_db\":40.5,\"lossless\":false,"
            "\"max_error\":0.25,\"min\":-1.0,\"max\":3.5,\"thumbnail\":true},"
            "{\"path\":\"/out/b.nvdb\",\"bytes\":2000,\"rate\":4.0,\"psnr_db\":null,\"lossless\":true,"
            "\"max_error\":null,\"min\":null,\"max\":null,\"thumbnail\":false}],\"log_tail\":\"line\\n\"}\n");
}

TEST_F(ApiTest, ShowsEveryFieldOfTheStatus) {
  control_.now.version = "0.1.0";
  control_.now.config = "/etc/weir.toml";
  control_.now.running.push_back({5, "/scratch/run 1", "/scratch/5.raw", "convert", std::nullopt, 2, 100, 1000});
  WatchView watch;
  watch.label = "run";
  watch.directory = "/scratch/run 1";
  watch.output = "/out";
  watch.method = "inotify";
  watch.up = true;
  watch.waiting_bytes = 300;
  watch.done_per_min = 1.5;
  control_.now.watches.push_back(watch);
  control_.now.arrived = {12, 100.5};
  control_.now.converted = {11, 90};
  control_.now.waiting_bytes = 300;
  control_.now.disks.push_back({"/scratch", {"/out", "/scratch/b"}, 1000, 4000, 2.5, 400, "no room in /out"});
  EXPECT_EQ(ask("GET", "/api/status").body,
            "{\"version\":\"0.1.0\",\"config\":\"/etc/weir.toml\",\"state\":\"running\",\"reason\":\"\","
            "\"started_at\":0.0,\"queue_age_s\":0.0,\"bytes_per_s\":0.0,\"jobs_at_once\":1,"
            "\"jobs\":{\"discovered\":0,\"waiting\":1,\"running\":1,\"done\":2,\"failed\":1,\"quarantined\":0,"
            "\"cancelled\":0},\"done_total\":0,\"bytes_in_total\":0,\"bytes_out_total\":0,\"arrived_per_min\":12.0,"
            "\"arrived_bytes_per_s\":100.5,\"done_per_min\":11.0,\"converted_bytes_per_s\":90.0,"
            "\"waiting_bytes\":300,\"queue_ends_in_s\":null,\"disks\":[{\"path\":\"/scratch\","
            "\"directories\":[\"/out\",\"/scratch/b\"],\"free_bytes\":1000,\"total_bytes\":4000,"
            "\"written_bytes_per_s\":2.5,\"fills_in_s\":400.0,\"held\":\"no room in /out\"}],\"running\":[{\"id\":5,"
            "\"watch\":\"/scratch/run 1\",\"source\":\"/scratch/5.raw\",\"step\":\"convert\",\"fraction\":null,"
            "\"seconds\":2.0,\"source_bytes\":100,\"rss_bytes\":1000,\"stall\":\"\"}],\"watches\":[{\"label\":\"run\","
            "\"directory\":\"/scratch/run 1\",\"output\":\"/out\",\"method\":\"inotify\",\"up\":true,\"reason\":\"\","
            "\"jobs\":{\"discovered\":0,\"waiting\":0,\"running\":0,\"done\":0,\"failed\":0,\"quarantined\":0,"
            "\"cancelled\":0},\"waiting_bytes\":300,\"done_per_min\":1.5,\"overflows\":0,\"last_done\":null}],"
            "\"viewer\":{\"state\":\"none\",\"reason\":\"\",\"file\":\"\",\"connections\":0,\"rss_bytes\":0,"
            "\"memory_bytes\":0},\"control_at\":null}\n");
}

TEST_F(ApiTest, GroupsProblems) {
  for (JobView& job : control_.all) {
    job.state = JobState::quarantined;
    job.reason = cat(job.source, ": has ", 10 * job.id, " bytes");
  }
  control_.all[1].reason = "is strange";
  EXPECT_EQ(ask("GET", "/api/problems").body,
            "{\"total\":5,\"groups\":[{\"key\":\"has # bytes\",\"reason\":\"has 10 bytes\",\"state\":\"quarantined\","
            "\"count\":4,\"changed_at\":0.0,\"newest\":1},{\"key\":\"is strange\",\"reason\":\"is strange\","
            "\"state\":\"quarantined\",\"count\":1,\"changed_at\":0.0,\"newest\":2}]}\n");
  EXPECT_EQ(Json::parse(ask("GET", "/api/problems?limit=1").body).at("groups").size(), 1U);
  EXPECT_EQ(ask("GET", "/api/problems?limit=1001").status, 400U);
  EXPECT_EQ(Json::parse(ask("GET", "/api/jobs?problem=has%20%23%20bytes").body).at("total"), 4);
  EXPECT_EQ(ask("POST", "/api/retry-failed?problem=has+%23+bytes").body, "{\"retried\":4}\n");
  EXPECT_EQ(control_.asked, std::vector<std::string>{"retry problem has # bytes"});
  EXPECT_EQ(ask("POST", "/api/retry-failed?problem=").body,
            "{\"error\":\"problem=: give problem=KEY as /api/problems says it, or leave it out\"}\n");
  EXPECT_EQ(control_.asked.size(), 1U);
}

TEST_F(ApiTest, SearchesAndSortsJobs) {
  EXPECT_EQ(Json::parse(ask("GET", "/api/jobs?text=/5.raw").body).at("total"), 1);
  const auto order_of = [&](const std::string& query) {
    EXPECT_EQ(ask("GET", cat("/api/jobs?", query)).status, 200U) << query;
    return control_.asked_for.order;
  };
  EXPECT_FALSE(order_of("limit=1").has_value());
  EXPECT_EQ(order_of("sort=bytes")->key, JobOrderKey::bytes);
  EXPECT_TRUE(order_of("sort=bytes")->descending);
  EXPECT_FALSE(order_of("sort=source&order=asc")->descending);
  EXPECT_EQ(order_of("order=desc")->key, JobOrderKey::changed);
  for (const char* query : {"sort=colour", "sort=", "order=up", "sort=bytes&order="}) {
    const HttpResponse refused = ask("GET", cat("/api/jobs?", query));
    EXPECT_EQ(refused.status, 400U) << query;
    EXPECT_EQ(refused.body,
              "{\"error\":\"sort is one of changed, discovered, source, state, watch, bytes, seconds; order is asc or "
              "desc\"}\n");
  }
}

TEST_F(ApiTest, UnknownJobId_Is404) {
  for (const char* id : {"6", "0", "-1", "x", "1.0", "99999999999999999999", "1%20"}) {
    for (const char* action : {"", "/retry", "/cancel"}) {
      const HttpResponse response = ask(*action == '\0' ? "GET" : "POST", cat("/api/jobs/", id, action));
      EXPECT_EQ(response.status, 404U) << id << action;
    }
  }
  EXPECT_EQ(ask("GET", "/api/jobs/6").body, "{\"error\":\"there is no job 6\"}\n");
  EXPECT_TRUE(control_.asked.empty());
}

TEST_F(ApiTest, RetriesAndCancelsJobs) {
  EXPECT_EQ(Json::parse(ask("POST", "/api/jobs/3/retry").body).at("state"), "waiting");
  EXPECT_EQ(Json::parse(ask("POST", "/api/jobs/5/cancel").body).at("state"), "cancelled");
  EXPECT_EQ(control_.asked, (std::vector<std::string>{"retry 3", "cancel 5"}));
  EXPECT_EQ(ask("POST", "/api/jobs/1/retry?force=yes").body,
            "{\"error\":\"force=yes: give force=1, or leave it out\"}\n");
  const HttpResponse again = ask("POST", "/api/jobs/3/retry");
  EXPECT_EQ(again.status, 409U);
  EXPECT_EQ(again.body, "{\"error\":\"job 3 is waiting: nothing to retry\"}\n");
  EXPECT_EQ(ask("POST", "/api/jobs/1/cancel").body, "{\"error\":\"job 1 is done: nothing to cancel\"}\n");
}

TEST_F(ApiTest, PausesResumesAndRetriesFailedJobs) {
  EXPECT_EQ(Json::parse(ask("POST", "/api/pause").body).at("state"), "paused");
  EXPECT_EQ(Json::parse(ask("POST", "/api/resume").body).at("state"), "running");
  EXPECT_EQ(ask("POST", "/api/retry-failed").body, "{\"retried\":1}\n");
  EXPECT_EQ(control_.asked, (std::vector<std::string>{"pause", "resume", "retry all"}));
}

TEST_F(ApiTest, UnknownRouteIs404AndWrongMethodIs405) {
  for (const char* target : {"/api", "/api/", "/api/jobs/", "/api/jobs/1/", "/api/jobs/1/retry/x", "/nowhere", "//",
                             "/page/../metrics", "/healthz/"}) {
    EXPECT_EQ(ask("GET", target).status, 404U) << target;
  }
  EXPECT_EQ(ask("GET", "/nowhere").body, "{\"error\":\"there is nothing at /nowhere\"}\n");
  const HttpResponse get = ask("GET", "/api/pause");
  EXPECT_EQ(get.status, 405U);
  EXPECT_EQ(header(get, "Allow"), "POST");
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "get"}) {
    const HttpResponse response = ask(method, "/api/jobs");
    EXPECT_EQ(response.status, 405U) << method;
    EXPECT_EQ(header(response, "Allow"), "GET, HEAD");
    EXPECT_EQ(response.body, cat("{\"error\":\"", method, " is not for /api/jobs; use GET, HEAD\"}\n"));
  }
  EXPECT_EQ(ask("HEAD", "/api/jobs").status, 200U);
  EXPECT_EQ(ask("HEAD", "/api/pause").status, 405U);
  EXPECT_EQ(ask("GET", "http://localhost/").status, 400U);
  EXPECT_TRUE(control_.asked.empty());
}

// The document writes "/api/jobs/*" as `/api/jobs/ID`.
TEST(ApiDocument, HasEveryRouteAndNoOther) {
  const std::string document = read_file(WEIR_SOURCE_DIR "/docs/http-api.md");
  std::set<std::string> described;
  for (const std::string& line : split(document, '\n')) {
    if (!line.starts_with("| `GET /") && !line.starts_with("| `POST /")) continue;
    std::string route = line.substr(3, line.find('`', 3) - 3);
    for (const char* name : {"/ID", "/NAME", "/N"}) {
      const std::size_t at = route.find(name);
      const std::size_t end = at + std::string_view(name).size();
      if (at != std::string::npos && (end == route.size() || route[end] == '/')) route.replace(at, end - at, "/*");
    }
    EXPECT_TRUE(described.insert(route).second) << route;
  }
  const std::vector<std::string> routes = api_routes();
  EXPECT_EQ(described, std::set<std::string>(routes.begin(), routes.end()));
}

TEST_F(ApiTest, ServesThumbnailsOfKnownOutputsOnly) {
  TemporaryDirectory directory;
  const std::string png = "\x89PNG\r\n\x1a\nrest";
  std::ofstream(directory / "a.png") << png;
  std::ofstream(directory / "passwd") << "root:x:0:0";
  std::filesystem::create_symlink(directory / "a.png", directory / "link.png");
  control_.thumbnails = {{{1, 0}, directory / "a.png"},
                         {{1, 1}, directory / "passwd"},
                         {{1, 2}, directory / "gone.png"},
                         {{1, 3}, directory / "link.png"},
                         {{1, 4}, directory.path().string()}};
  const HttpResponse found = ask("GET", "/api/jobs/1/thumbnails/0?changed=1795253271");
  EXPECT_EQ(found.status, 200U);
  EXPECT_EQ(found.content_type, "image/png");
  EXPECT_EQ(found.body, png);
  EXPECT_EQ(header(found, "Cache-Control"), "private, max-age=86400");
  for (const char* other : {"1", "2", "3", "4", "5", "-1", "x", "..%2F..%2Fetc%2Fpasswd"}) {
    EXPECT_EQ(ask("GET", cat("/api/jobs/1/thumbnails/", other)).status, 404U) << other;
  }
  EXPECT_EQ(ask("GET", "/api/jobs/1/thumbnails/1").body, "{\"error\":\"job 1 has no thumbnail 1\"}\n");
  EXPECT_EQ(ask("GET", "/api/jobs/1/thumbnails/-1").body, "{\"error\":\"job 1 has no thumbnail -1\"}\n");
  EXPECT_EQ(ask("GET", "/api/jobs/1/thumbnails/x").body, "{\"error\":\"job 1 has no thumbnail x\"}\n");
  EXPECT_EQ(ask("GET", "/api/jobs/x/thumbnails/0").body, "{\"error\":\"there is no job x\"}\n");
  EXPECT_EQ(ask("GET", "/api/jobs/2/thumbnails/0").status, 404U);
}

TEST_F(ApiTest, ServesThePage) {
  const HttpResponse page = ask("GET", "/");
  EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
  EXPECT_TRUE(page.body.starts_with("<!doctype html>"));
  EXPECT_EQ(ask("GET", "/page/page.css").content_type, "text/css; charset=utf-8");
  EXPECT_EQ(ask("GET", "/page/page.js").content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(ask("GET", "/page/icon.svg").content_type, "image/svg+xml");
  EXPECT_EQ(ask("GET", "/page/..").status, 404U);
  EXPECT_EQ(ask("GET", "/page/%2Fetc%2Fpasswd").status, 404U);
  // The page must not contain anything that its content policy forbids, because it would not work.
  EXPECT_EQ(page.body.find("style="), std::string::npos);
  EXPECT_EQ(page.body.find("onclick"), std::string::npos);
  EXPECT_EQ(page.body.find("//"), std::string::npos) << "an address elsewhere";
}

TEST_F(ApiTest, SendsSecurityHeadersWithEverything) {
  for (const char* target : {"/", "/api/jobs", "/nowhere", "http://elsewhere/"}) {
    const HttpResponse response = ask("GET", target);
    EXPECT_EQ(header(response, "Content-Security-Policy"),
              "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
              "base-uri 'none'; form-action 'none'; frame-ancestors 'none'")
        << target;
    EXPECT_EQ(header(response, "X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(header(response, "X-Frame-Options"), "DENY");
    EXPECT_EQ(header(response, "Referrer-Policy"), "no-referrer");
    EXPECT_EQ(header(response, "Cross-Origin-Resource-Policy"), "same-origin");
    EXPECT_EQ(header(response, "Cache-Control"), "no-store");
  }
}

TEST_F(ApiTest, DataWithoutTheToken_Is401) {
  const Api api(control_, {"secret", true});
  const auto status = [&](const std::string& target, const std::string& authorization) {
    HttpRequest request;
    request.target = target;
    request.authorization = authorization;
    return api.answer(request).status;
  };
  for (const char* target :
       {"/metrics", "/api/status", "/api/jobs", "/api/jobs/1", "/api/jobs/1/thumbnails/0", "/api/pause", "/nowhere"}) {
    EXPECT_EQ(status(target, ""), 401U) << target;
    EXPECT_EQ(status(target, "Bearer wrong"), 401U) << target;
    EXPECT_NE(status(target, "Bearer secret"), 401U) << target;
  }
  control_.readiness_now = {false, "/scratch/run: not there"};
  HttpRequest ready;
  ready.target = "/readyz";
  EXPECT_EQ(api.answer(ready).body, "not ready\n");
  ready.authorization = "Bearer secret";
  EXPECT_EQ(api.answer(ready).body, "not ready: /scratch/run: not there\n");
  for (const char* target : {"/", "/page/page.js", "/healthz"}) EXPECT_EQ(status(target, ""), 200U) << target;
}

TEST_F(ApiTest, RefusesRequestsOfForeignPages) {
  HttpRequest post;
  post.method = "POST";
  post.target = "/api/pause";
  post.content_type = "text/plain";
  EXPECT_EQ(api_.answer(post).status, 403U);
  HttpRequest rebound;
  rebound.target = "/api/jobs";
  rebound.host = "attacker.example";
  EXPECT_EQ(api_.answer(rebound).status, 421U);
  EXPECT_TRUE(control_.asked.empty());
}

}  // namespace
}  // namespace weir::api_test
