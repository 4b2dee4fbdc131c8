#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/http/api.h"
#include "format/base/text.h"
#include "ingest/files/numbered_series.h"
#include "tests/daemon/support/fake_control.h"

namespace weir::api_viewer_test {
namespace {

using Json = nlohmann::json;

TEST(ApiViewer, IsOpenedAtADoneJobsOutput) {
  FakeControl control;
  for (const JobState state : {JobState::done, JobState::failed}) {
    JobView job;
    job.id = static_cast<std::int64_t>(control.all.size()) + 1;
    job.state = state;
    control.all.push_back(job);
  }
  const Api api(control, {});
  const auto ask = [&](const std::string& method, const std::string& target) {
    HttpRequest request;
    request.method = method;
    request.target = target;
    request.host = "localhost:8470";
    request.marked = true;
    return api.answer(request);
  };
  const auto get = [&](const std::string& target) { return Json::parse(ask("GET", target).body); };
  OutputView output;
  output.path = "/out/a b+1.nvdb";
  control.all[0].outputs = {output, output};
  control.now.viewer.state = ViewerState::starting;
  control.now.viewer.memory_bytes = 1 << 27;
  const HttpResponse made = ask("POST", "/api/jobs/1/view?output=1");
  EXPECT_EQ(made.status, 200U);
  EXPECT_EQ(
      made.body,
      cat("{\"state\":\"starting\",\"reason\":\"\",\"file\":\"/out/a b+1.nvdb\",\"connections\":0,\"rss_bytes\":0,"
          "\"memory_bytes\":134217728,\"url\":\"/view/?series=",
          series_digest("/out/a b+9.nvdb"), "&job=1&output=1#f=a%20b%2B1.nvdb\"}\n"));
  EXPECT_EQ(get("/api/viewer").at("state"), "starting");
  EXPECT_EQ(get("/api/status").at("viewer").at("file"), "/out/a b+1.nvdb");
  const auto refused = [&](const std::string& target) {
    const HttpResponse response = ask("POST", target);
    return cat(response.status, ' ', Json::parse(response.body).at("error").get<std::string>());
  };
  EXPECT_EQ(refused("/api/jobs/9/view"), "404 there is no job 9");
  EXPECT_EQ(refused("/api/jobs/x/view"), "404 there is no job x");
  EXPECT_EQ(refused("/api/jobs/1/view?output=2"), "404 job 1 has no output 2");
  EXPECT_EQ(refused("/api/jobs/2/view"), "409 job 2 is failed: nothing to view");
  EXPECT_EQ(refused("/api/jobs/1/view?force=yes"),
            "400 give output=N, the place of an output from 0 on, and force=1, or leave them out");
  control.view_taken = true;
  EXPECT_EQ(refused("/api/jobs/1/view"),
            "423 somebody looks at /out/a b+1.nvdb, or opens it; wait until that page is closed, or take the viewer "
            "with force=1");
  EXPECT_EQ(ask("POST", "/api/jobs/1/view?force=1").status, 200U);
  control.now.viewer = {ViewerState::off, "viewers are off", "", 0, 0, 0};
  EXPECT_EQ(refused("/api/jobs/1/view"), "409 viewers are off");
  EXPECT_EQ(control.asked, (std::vector<std::string>{"view 1 1", "force view 1 0"}));
}

}  // namespace
}  // namespace weir::api_viewer_test
