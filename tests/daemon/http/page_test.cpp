// Tests the page in a real browser with a service that converts nothing; page/page_test.py has the steps.
// WEIR_PAGE_SCREENSHOTS=DIRECTORY keeps screenshots.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "tests/daemon/support/fake_control.h"
#include "tests/daemon/support/sample_jobs.h"
#include "tests/daemon/support/served.h"
#include "tests/support/python.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::page_test {
namespace {

bool is_installed(const std::string& command) {
  return std::system(("command -v " + command + " >/dev/null").c_str()) == 0;
}

/// Shows the recorded requests to page_test.py as the reason of job 9999.
class TalkingControl : public FakeControl {
 public:
  std::function<void()> on_pause;

  std::optional<JobView> job(std::int64_t id) override {
    if (id != 9999) return FakeControl::job(id);
    JobView told;
    for (const std::string& what : asked) told.reason += (told.reason.empty() ? "" : ", ") + what;
    return told;
  }
  void pause() override {
    FakeControl::pause();
    if (on_pause) on_pause();
  }
};

class PageTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!is_installed("chromium") || !is_installed("chromedriver")) {
      GTEST_SKIP() << "chromium or chromedriver is not installed; see tools/setup.sh";
    }
    control_.now.state = "running";
    control_.now.version = "0.1.0";
    control_.now.started_at = 1795253270;
  }

  void run(const std::string& name, const std::string& token = "", const std::string& control_socket = "") {
    Served served(control_, token, {}, control_socket);
    if (name == "says_when_the_service_is_gone") control_.on_pause = [&] { served.close_soon(); };
    std::vector<std::string> command = {kPython, "-B", WEIR_SOURCE_DIR "/tests/daemon/page/page_test.py",
                                        "http://" + served.address(), name};
    if (const char* directory = std::getenv("WEIR_PAGE_SCREENSHOTS")) command.emplace_back(directory);
    const CommandResult result = run_command(command);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  }

  TemporaryDirectory directory_;
  TalkingControl control_;
};

TEST_F(PageTest, ShowsTheService) {
  show_sample_jobs(control_, directory_.path());
  run("shows_the_service");
}

TEST_F(PageTest, FitsANarrowWindow) {
  show_sample_jobs(control_, directory_.path());
  run("fits_a_narrow_window");
}

TEST_F(PageTest, PlaysTheSeries) {
  show_sample_jobs(control_, directory_.path());
  run("plays_the_series");
}

TEST_F(PageTest, WorksWithTheKeyboard) {
  show_sample_jobs(control_, directory_.path());
  run("works_with_the_keyboard");
}

TEST_F(PageTest, ChangesJobs) {
  show_sample_jobs(control_, directory_.path());
  run("changes_jobs");
}

TEST_F(PageTest, HasNoButtonsWhereOnlyTheSocketControls) {
  show_busy_sample(control_, directory_.path());
  run("only_views", "", directory_ / "weir.sock");
}

TEST_F(PageTest, ShowsAnEmptyService) {
  WatchView watch;
  watch.label = watch.directory = "/scratch/run42";
  watch.output = "/scratch/run42/nvdb";
  watch.method = "inotify";
  watch.up = true;
  control_.now.watches = {watch};
  run("shows_an_empty_service");
}

TEST_F(PageTest, ShowsWhatIsWrong) {
  show_sample_jobs(control_, directory_.path());
  control_.now.state = "paused";
  control_.now.reason = "/scratch has 1.2 GiB free and 4.0 GiB are needed";
  control_.now.viewer.state = ViewerState::off;
  control_.now.watches[1].up = false;
  control_.now.watches[1].reason = "it is not there; it is looked for every second";
  run("shows_what_is_wrong");
}

TEST_F(PageTest, SaysWhyThereIsNoViewer) {
  show_sample_jobs(control_, directory_.path());
  control_.view_taken = true;
  control_.now.viewer.state = ViewerState::failed;
  control_.now.viewer.reason = "/scratch/run42/nvdb/density_24.nvdb: cannot open: No such file or directory";
  run("says_why_there_is_no_viewer");
}

TEST_F(PageTest, WaitsForTheViewer) {
  control_.now.viewer.state = ViewerState::starting;
  run("waits_for_the_viewer");
}

TEST_F(PageTest, SaysWhenTheServiceIsGone) {
  show_sample_jobs(control_, directory_.path());
  run("says_when_the_service_is_gone");
}

TEST_F(PageTest, AsksForTheToken) {
  show_sample_jobs(control_, directory_.path());
  run("asks_for_the_token", "secret");
}

TEST_F(PageTest, ShowsFlowAndDisks) {
  show_busy_sample(control_, directory_.path());
  run("shows_flow_and_disks");
}

TEST_F(PageTest, GroupsProblems) {
  show_busy_sample(control_, directory_.path());
  run("groups_problems");
}

TEST_F(PageTest, ListsAllJobs) {
  show_busy_sample(control_, directory_.path());
  run("lists_all_jobs");
}

TEST_F(PageTest, ShowsWhyFilesWait) {
  show_busy_sample(control_, directory_.path());
  run("shows_why_files_wait");
}

TEST_F(PageTest, ShowsPlots) {
  show_busy_sample(control_, directory_.path());
  run("shows_plots");
}

TEST_F(PageTest, EnlargesPictures) {
  show_busy_sample(control_, directory_.path());
  run("enlarges_pictures");
}

TEST_F(PageTest, CopiesPaths) {
  show_busy_sample(control_, directory_.path());
  run("copies_paths");
}

TEST_F(PageTest, ClampsLongNames) {
  show_busy_sample(control_, directory_.path());
  run("clamps_long_names");
}

TEST_F(PageTest, HasLargeTargets) {
  show_busy_sample(control_, directory_.path());
  run("has_large_targets");
}

}  // namespace
}  // namespace weir::page_test
