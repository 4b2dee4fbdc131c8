// Tests weir jobs, status and retry as a user runs them, against a service that converts nothing.
#include "tools/service/service_client.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "daemon/http/http_server.h"
#include "format/base/text.h"
#include "tests/daemon/support/fake_control.h"
#include "tests/daemon/support/served.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/unreadable_file.h"

namespace weir::service_client_test {
namespace {

class ServiceCommands : public testing::Test {
 protected:
  ServiceCommands() {
    for (int id = 1; id <= 3; ++id) {
      JobView job;
      job.id = id;
      job.watch = "/scratch/run 1";
      job.source = cat("/scratch/run 1/", id, ".raw");
      job.state = id == 1 ? JobState::done : JobState::failed;
      control_.all.push_back(job);
    }
    control_.now.state = "running";
    control_.now.version = "0.1.0";
  }

  CommandResult weir(const Served& served, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--address", served.address()});
    return run_weir(arguments);
  }

  FakeControl control_;
  TemporaryDirectory directory_;
};

TEST_F(ServiceCommands, ListJobs) {
  const Served served(control_);
  const CommandResult all = weir(served, {"jobs"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(split(all.out, '\n').size(), 5U) << all.out;
  const CommandResult failed =
      weir(served, {"jobs", "--state", "failed", "--watch", "/scratch/run 1", "--limit", "1", "--json"});
  EXPECT_EQ(failed.exit_code, 0) << failed.err;
  const auto page = nlohmann::json::parse(failed.out);
  EXPECT_EQ(page.at("total"), 2);
  EXPECT_EQ(page.at("jobs").size(), 1U);
  EXPECT_EQ(page.at("jobs")[0].at("id"), 2);
  EXPECT_EQ(weir(served, {"jobs", "--state", "done", "--offset", "5"}).out, "no jobs beyond 1\n");
}

TEST_F(ServiceCommands, JobsOfAnUnknownWatch_AreRefusedWithTheLabels) {
  for (const char* label : {"/scratch/run 2", "all"}) {
    control_.now.watches.emplace_back();
    control_.now.watches.back().label = label;
  }
  const Served served(control_);
  const CommandResult unknown = weir(served, {"jobs", "--watch", "nope"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_EQ(unknown.err, "weir: --watch is \"nope\", which no watch is called; there are /scratch/run 2, all\n");
  EXPECT_EQ(unknown.out, "");
  EXPECT_EQ(weir(served, {"jobs", "--watch", "all"}).out, "no such jobs\n") << "it has none yet";
  const CommandResult former = weir(served, {"jobs", "--watch", "/scratch/run 1", "--state", "waiting"});
  EXPECT_EQ(former.exit_code, 0) << "it has jobs, though the configuration names it no more; " << former.err;
}

TEST_F(ServiceCommands, ShowTheStatus) {
  const Served served(control_);
  const CommandResult text = weir(served, {"status"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("\njobs        0 waiting, 0 running, 1 done, 2 failed\n"), std::string::npos) << text.out;
  const auto status = nlohmann::json::parse(weir(served, {"status", "--json"}).out);
  EXPECT_EQ(status.at("state"), "running");
}

TEST_F(ServiceCommands, RetryJobs) {
  Served served(control_);
  const CommandResult one = weir(served, {"retry", "2", "1"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, "job 2 is tried again: /scratch/run 1/2.raw\njob 1 is tried again: /scratch/run 1/1.raw\n");
  const CommandResult all = weir(served, {"retry", "--all-failed"});
  EXPECT_EQ(all.out, "1 job is tried again\n");
  const CommandResult json = weir(served, {"retry", "--all-failed", "--json"});
  EXPECT_EQ(json.out, "{\"retried\":0}\n");
  EXPECT_EQ(served.run([&] { return control_.asked; }),
            (std::vector<std::string>{"retry 2", "retry 1", "retry all", "retry all"}));
  const CommandResult again = weir(served, {"retry", "2"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_EQ(again.err, cat("weir: ", served.address(), ": job 2 is waiting: nothing to retry\n"));
  EXPECT_EQ(weir(served, {"retry", "77"}).err, cat("weir: ", served.address(), ": there is no job 77\n"));
}

TEST_F(ServiceCommands, RetryAndCancel_OneJobRefused_AskForTheOthers) {
  Served served(control_);
  const CommandResult retried = weir(served, {"retry", "77", "2", "78", "3"});
  EXPECT_EQ(retried.exit_code, 2);
  EXPECT_EQ(retried.out, "job 2 is tried again: /scratch/run 1/2.raw\njob 3 is tried again: /scratch/run 1/3.raw\n");
  EXPECT_EQ(retried.err,
            cat("weir: ", served.address(), ": there is no job 77; ", served.address(), ": there is no job 78\n"));
  const CommandResult cancelled = weir(served, {"cancel", "2", "77", "3", "77", "--json"});
  EXPECT_EQ(cancelled.exit_code, 2);
  EXPECT_EQ(nlohmann::json::parse(cancelled.out).at("jobs").size(), 2U) << cancelled.out;
  EXPECT_EQ(cancelled.err, cat("weir: ", served.address(), ": there is no job 77\n")) << "once";
  EXPECT_EQ(served.run([&] { return control_.asked; }),
            (std::vector<std::string>{"retry 2", "retry 3", "cancel 2", "cancel 3"}));
}

TEST_F(ServiceCommands, RetryJobs_NoServiceAnswers_IsSaidOnce) {
  std::string address;
  {
    const Served served(control_);
    address = served.address();
  }
  const CommandResult result = run_weir({"retry", "1", "2", "--json", "--address", address});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.out, "{\"jobs\":[]}\n");
  EXPECT_EQ(result.err.find(address), result.err.rfind(address)) << result.err;
}

TEST_F(ServiceCommands, CancelJobs) {
  Served served(control_);
  control_.all[1].state = JobState::waiting;
  const CommandResult one = weir(served, {"cancel", "2"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, "job 2 is cancelled: /scratch/run 1/2.raw\n");
  const CommandResult done = weir(served, {"cancel", "1"});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_EQ(done.err, cat("weir: ", served.address(), ": job 1 is done: nothing to cancel\n"));
  EXPECT_EQ(run_weir({"cancel"}).exit_code, 2);
}

TEST_F(ServiceCommands, PauseAndResume) {
  Served served(control_);
  const CommandResult paused = weir(served, {"pause"});
  EXPECT_EQ(paused.exit_code, 0) << paused.err;
  EXPECT_EQ(paused.out, "paused: nothing starts until weir resume, and 0 jobs go on to the end\n");
  EXPECT_EQ(weir(served, {"resume"}).out, "resumed: 0 jobs wait\n");
  served.run([&] { return control_.now.reason = "no room in /scratch"; });
  EXPECT_EQ(weir(served, {"resume"}).out,
            "resumed: 0 jobs wait; those that write to a full disk do not start yet: no room in /scratch\n");
  served.run([&] { return control_.stays_paused = true; });
  EXPECT_EQ(weir(served, {"resume"}).out, "resumed, but nothing starts yet: no room in /scratch\n");
  EXPECT_EQ(nlohmann::json::parse(weir(served, {"pause", "--json"}).out).at("version"), "0.1.0");
  EXPECT_EQ(served.run([&] { return control_.asked; }),
            (std::vector<std::string>{"pause", "resume", "resume", "resume", "pause"}));
}

TEST_F(ServiceCommands, AskAtTheUnixSocket) {
  const std::string socket = directory_ / "weir.sock";
  const std::string config = directory_ / "weir.toml";
  Served served(control_, "", {}, socket);
  std::ofstream(config) << "[service]\nlisten = \"" << served.address()
                        << "\"\ncontrol_socket = \"weir.sock\"\n[[watch]]\ndirectory = \"in\"\noutput = \"out\"\n";
  EXPECT_EQ(run_weir({"retry", "2", "--address", "unix:" + socket}).out,
            "job 2 is tried again: /scratch/run 1/2.raw\n");
  EXPECT_EQ(run_weir({"retry", "1", "--config", config}).out, "job 1 is tried again: /scratch/run 1/1.raw\n");
  ::chmod(socket.c_str(), 0);  // a user who may not control may still look
  EXPECT_EQ(run_weir({"jobs", "--config", config, "--state", "failed"}).exit_code, 0);
  const CommandResult refused = weir(served, {"retry", "3"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, cat("weir: ", served.address(), ": this address only shows; ask at unix:", socket,
                             " (--address, --config)\n"));
  served.close();
  const CommandResult gone = run_weir({"status", "--address", "unix:" + socket});
  EXPECT_EQ(gone.exit_code, 5);
  EXPECT_EQ(gone.err, cat("weir: unix:", socket,
                          ": cannot connect: No such file or directory; is weir watch running there? "
                          "name its address with --address or --config\n"));
  EXPECT_EQ(run_weir({"status", "--address", "unix:/" + std::string(103, 'x')}).exit_code, 2);
}

TEST_F(ServiceCommands, RetryNeedsEitherJobIdsOrAllFailed) {
  const CommandResult neither = run_weir({"retry"});
  EXPECT_EQ(neither.exit_code, 2);
  EXPECT_EQ(neither.err, "weir: give the IDs of the jobs to try again, as weir jobs lists them, or --all-failed\n");
  const CommandResult both = run_weir({"retry", "1", "--all-failed"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_EQ(both.err, "weir: give IDs or --all-failed, not both\n");
}

TEST_F(ServiceCommands, NoServiceAtTheAddress_IsReported) {
  std::string address;
  {
    const Served served(control_);
    address = served.address();
  }
  const CommandResult result = run_weir({"status", "--address", address});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, cat("weir: ", address,
                            ": cannot connect: Connection refused; is weir watch running there? name its address with "
                            "--address or --config\n"));
}

TEST_F(ServiceCommands, RefuseAMalformedAddress) {
  const CommandResult result = run_weir({"jobs", "--address", "8470"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "weir: --address: \"8470\" is no address; write HOST:PORT, as 127.0.0.1:8470 or [::1]:8470\n");
}

TEST_F(ServiceCommands, FileThatMayNotBeRead_ExitsWith5) {
  const std::string unreadable = unreadable_file();
  if (unreadable.empty()) GTEST_SKIP() << "this system has no file that root cannot read";
  const auto refused = [&](const char* option, const std::string& action) {
    const CommandResult result = run_weir({"status", option, unreadable});
    EXPECT_EQ(result.exit_code, 5) << option;
    EXPECT_EQ(result.err,
              cat("weir: ", unreadable, ": cannot ", action,
                  ": Permission denied; give this user the right to read it and to enter its directories\n"));
  };
  refused("--config", "read");
  refused("--token-file", "open");
}

TEST_F(ServiceCommands, SendTheTokenFromFileOrEnvironment) {
  const Served served(control_, "secret");
  const CommandResult without = weir(served, {"status"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_EQ(without.err, cat("weir: ", served.address(),
                             ": the service wants its token; give it with --token-file or WEIR_TOKEN\n"));
  write_file(directory_ / "token", "secret\n");
  EXPECT_EQ(weir(served, {"status", "--token-file", directory_ / "token"}).exit_code, 0);
  const CommandResult missing = weir(served, {"status", "--token-file", directory_ / "nope"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(missing.err, "weir: " + (directory_ / "nope") + ": cannot open: No such file or directory\n");
  write_file(directory_ / "other", "other\n");
  for (const std::string& empty : {directory_ / "empty", directory_.path().string()}) {
    if (empty == directory_ / "empty") write_file(empty, " \n");
    const CommandResult none = weir(served, {"status", "--token-file", empty});
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_EQ(none.err, "weir: " + empty + ": holds no token; name a file with one\n");
  }
  const CommandResult other = weir(served, {"status", "--token-file", directory_ / "other"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err, cat("weir: ", served.address(),
                           ": the service has another token than the one given; check --token-file, WEIR_TOKEN or the "
                           "token of --config\n"));
  CommandOptions options;
  options.environment = {"WEIR_TOKEN=secret"};
  EXPECT_EQ(run_weir({"jobs", "--address", served.address()}, options).exit_code, 0);
}

TEST_F(ServiceCommands, FindTheServiceOfAConfiguration) {
  const Served served(control_, "secret");
  std::filesystem::create_directory(directory_ / "in");
  const std::string watch = "[[watch]]\ndirectory = \"in\"\noutput = \"out\"\n";
  write_file(directory_ / "a.toml", cat("[service]\nlisten = \"", served.address(), "\"\ntoken = \"secret\"\n", watch));
  const CommandResult fixed = run_weir({"status", "--config", directory_ / "a.toml"});
  EXPECT_EQ(fixed.exit_code, 0) << fixed.err;
  const std::string any = "[service]\nlisten = \"127.0.0.1:0\"\ntoken = \"secret\"\n";
  write_file(directory_ / "b.toml", cat(any, "port_file = \"port\"\n", watch));
  write_file(directory_ / "port", cat(served.port(), '\n'));
  const CommandResult from_file = run_weir({"status", "--config", directory_ / "b.toml"});
  EXPECT_EQ(from_file.exit_code, 0) << from_file.err;
  write_file(directory_ / "port", "");
  EXPECT_EQ(run_weir({"status", "--config", directory_ / "b.toml"}).err,
            cat("weir: ", directory_ / "port", ": \"\" is no port; is weir watch running?\n"));
  write_file(directory_ / "c.toml", any + watch);
  EXPECT_EQ(run_weir({"status", "--config", directory_ / "c.toml"}).err,
            "weir: the configuration listens on any free port and has no port_file; give --address\n");
}

// The server accepts the connection but never answers, like a service that hangs with its file server.
TEST_F(ServiceCommands, InterruptBeforeTheAnswer_EndsTheCommand) {
  boost::asio::io_context io;
  boost::asio::ip::tcp::acceptor silent(io, {boost::asio::ip::make_address("127.0.0.1"), 0});
  const std::string address = cat("127.0.0.1:", silent.local_endpoint().port());
  ChildProcess child({WEIR_COMMAND, "status", "--address", address});
  const auto connection = silent.accept();
  child.send_signal(SIGINT);
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err, cat("weir: ", address, ": interrupted before it answered\n"));
}

// Another program may listen at the address.
TEST_F(ServiceCommands, AnswerOfAnotherServer_IsReported) {
  boost::asio::io_context io;
  HttpResponse response{200, "text/html", "<html>", {}};
  const HttpServer other(io, {"127.0.0.1", 0}, {}, [&](const HttpRequest&) { return response; });
  std::thread thread([&] { io.run(); });
  const std::string address = cat("127.0.0.1:", other.port());
  CommandResult result = run_weir({"status", "--address", address});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, cat("weir: ", address, ": the answer is not weir's\n"));
  response.status = 404;
  result = run_weir({"status", "--address", address});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, cat("weir: ", address, ": the answer is 404 and not weir's\n"));
  response = {200, "application/json", "{\"state\":7}", {}};
  result = run_weir({"status", "--address", address});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, cat("weir: ", address, ": the answer is not weir's\n"));
  io.stop();
  thread.join();
}

}  // namespace
}  // namespace weir::service_client_test
