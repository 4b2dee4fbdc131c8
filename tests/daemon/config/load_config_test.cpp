#include "daemon/config/load_config.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/support/message_of_error.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/unreadable_file.h"

namespace weir::config_test {
namespace {

const std::string kWatch = "[[watch]]\ndirectory = 'in'\noutput = 'out'\n";

class Config : public testing::Test {
 protected:
  DaemonConfig load(const std::string& text) {
    write_file(path_, text);
    return load_config(path_);
  }
  /// Returns the message without the path before ":LINE:COLUMN: "; empty if the text is accepted.
  std::string refusal(const std::string& text) {
    try {
      load(text);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(path_ + ":")) << message;
      return message.substr(path_.size() + 1);
    }
  }
  /// Returns the refusal of a key in the fourth line, in the [[watch]].
  std::string watch_refusal(const std::string& line) { return refusal(kWatch + line); }
  /// Returns the refusal of a key in the second line, in [service].
  std::string service_refusal(const std::string& line) { return refusal("[service]\n" + line + "\n" + kWatch); }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "watch.toml";
};

// systemd sets this variable for a unit with StateDirectory, which may not write to /etc.
TEST_F(Config, StateLiesInTheStateDirectoryOfTheUnit) {
  ::setenv("STATE_DIRECTORY", "/var/lib/weir/run42:/var/lib/other", 1);
  EXPECT_EQ(load(kWatch).service.state, "/var/lib/weir/run42/weir.db");
  EXPECT_EQ(load("[service]\nstate = 'mine.db'\n" + kWatch).service.state, directory_ / "mine.db");
  ::unsetenv("STATE_DIRECTORY");
}

TEST_F(Config, Defaults) {
  const DaemonConfig config = load(kWatch);
  EXPECT_EQ(config.path, path_);
  EXPECT_EQ(config.service.state, directory_ / "weir.db");
  EXPECT_EQ(config.service.listen.text(), "127.0.0.1:8470");
  EXPECT_EQ(config.service.memory, 1073741824U);
  EXPECT_EQ(config.service.viewer_memory, 201326592U);
  EXPECT_EQ(job_memory(config.service), 805306368U);
  EXPECT_EQ(config.service.jobs, 1);
  EXPECT_EQ(config.service.work_dir, "");
  EXPECT_EQ(config.service.log_file, "");
  EXPECT_EQ(config.service.log_level, "info");
  ASSERT_EQ(config.watches.size(), 1U);
  const WatchConfig& watch = config.watches[0];
  EXPECT_EQ(watch.label, directory_ / "in");
  EXPECT_EQ(watch.directory, directory_ / "in");
  EXPECT_EQ(watch.output, directory_ / "out");
  EXPECT_EQ(watch.name, "");
  EXPECT_FALSE(watch.recursive);
  EXPECT_TRUE(watch.include.empty());
  EXPECT_EQ(watch.complete, Completion::automatic);
  EXPECT_EQ(watch.watch, WatchMethod::automatic);
  EXPECT_EQ(watch.priority, Priority::oldest);
  EXPECT_EQ(watch.source, AfterDone::keep);
  EXPECT_TRUE(watch.thumbnails);
  EXPECT_TRUE(watch.convert_options.empty());
  EXPECT_TRUE(watch.excluded_paths.empty());
}

TEST_F(Config, EveryKeyIsRead) {
  const DaemonConfig config = load(R"([service]
state = "var/state.db"
listen = "[::1]:0"
control_socket = "weir.sock"
port_file = "/run/weir.port"
memory = "2GiB"
viewer_memory = "300MiB"
jobs = 3
threads = 2
nice = 19
io_class = "idle"
bandwidth = 200000000
work_dir = "work/"
grace = 2.5
history = 0.5
log = "log/weir.log"
log_level = "debug"
log_size = "1MB"
log_files = 9
[[watch]]
label = "density"
directory = "../run/./42/"
output = "/scratch/nvdb"
output_mount = "/scratch"
recursive = true
include = ["*.h5", "*.nc"]
exclude = ["checkpoint*"]
name = "{stem}_{step}.nvdb"
complete = "marker"
marker = ".ok"
settle = 0.5
watch = "poll"
poll_interval = 3
priority = "newest"
source = "delete-after-verify"
delete_after = 5
follow = "anywhere"
thumbnails = false
dataset = "/fields/density"
psnr = 60
index = [0, "*"]
)");
  const ServiceConfig& service = config.service;
  EXPECT_EQ(service.state, directory_ / "var/state.db");
  EXPECT_EQ(service.listen.host, "::1");
  EXPECT_EQ(service.listen.port, 0);
  EXPECT_EQ(service.control_socket, directory_ / "weir.sock");
  EXPECT_EQ(service.port_file, "/run/weir.port");
  EXPECT_EQ(service.memory, std::uint64_t{2} << 30);
  EXPECT_EQ(service.viewer_memory, std::uint64_t{300} << 20);
  EXPECT_EQ(job_memory(service), (std::uint64_t{2048 - 64 - 300} << 20) / 3);
  EXPECT_EQ(service.jobs, 3);
  EXPECT_EQ(service.threads, 2);
  EXPECT_EQ(service.nice, 19);
  EXPECT_EQ(service.io_class, IoClass::idle);
  EXPECT_EQ(service.bandwidth, 200000000U);
  EXPECT_EQ(service.work_dir, directory_ / "work");
  EXPECT_EQ(service.grace_s, 2.5);
  EXPECT_EQ(service.history_days, 0.5);
  EXPECT_EQ(service.log_file, directory_ / "log/weir.log");
  EXPECT_EQ(service.log_level, "debug");
  EXPECT_EQ(service.log_size, 1000000U);
  EXPECT_EQ(service.log_files, 9);
  const WatchConfig& watch = config.watches.at(0);
  EXPECT_EQ(watch.label, "density");
  EXPECT_EQ(watch.directory, (directory_.path().parent_path() / "run/42").string());
  EXPECT_EQ(watch.output, "/scratch/nvdb");
  EXPECT_EQ(watch.output_mount, "/scratch");
  EXPECT_TRUE(watch.recursive);
  EXPECT_EQ(watch.include, (std::vector<std::string>{"*.h5", "*.nc"}));
  EXPECT_EQ(watch.exclude, std::vector<std::string>{"checkpoint*"});
  EXPECT_EQ(watch.name, "{stem}_{step}.nvdb");
  EXPECT_EQ(watch.complete, Completion::marker);
  EXPECT_EQ(watch.marker, ".ok");
  EXPECT_EQ(watch.settle_s, 0.5);
  EXPECT_EQ(watch.watch, WatchMethod::poll);
  EXPECT_EQ(watch.poll_interval_s, 3);
  EXPECT_EQ(watch.priority, Priority::newest);
  EXPECT_EQ(watch.source, AfterDone::delete_after_verify);
  EXPECT_EQ(watch.delete_after_s, 5);
  EXPECT_EQ(watch.follow, Follow::anywhere);
  EXPECT_FALSE(watch.thumbnails);
  EXPECT_EQ(watch.convert_options, (std::vector<std::string>{"--dataset=/fields/density", "--index=0,*", "--psnr=60"}));
  EXPECT_EQ(watch.convert_option("psnr"), "60");
  EXPECT_EQ(watch.convert_option("dataset"), "/fields/density");
  EXPECT_EQ(watch.convert_option("rate"), std::nullopt);
  EXPECT_EQ(load(kWatch + "lossless = true").watches[0].convert_option("lossless"), "true");
}

TEST_F(Config, DurationsAreSecondsOrTexts) {
  const DaemonConfig config = load("[service]\ngrace = '2min'\n" + kWatch +
                                   "delete_after = '10min'\nsettle = '0.5s'\npoll_interval = '1min'\n");
  EXPECT_EQ(config.service.grace_s, 120);
  EXPECT_EQ(config.watches.at(0).delete_after_s, 600);
  EXPECT_EQ(config.watches.at(0).settle_s, 0.5);
  EXPECT_EQ(config.watches.at(0).poll_interval_s, 60);
}

TEST_F(Config, UnknownKeysAreNamedWithTheirPlace) {
  EXPECT_EQ(refusal("extra = 1\n" + kWatch),
            "1:1: unknown key \"extra\" in the configuration; there are service, watch");
  EXPECT_TRUE(service_refusal("memmory = 1").starts_with("2:1: unknown key \"memmory\" in [service]; there are "));
  EXPECT_TRUE(watch_refusal("  stack = true").starts_with("4:3: unknown key \"stack\" in [[watch]]; there are "));
  EXPECT_TRUE(watch_refusal("overwrite = true").starts_with("4:1: unknown key \"overwrite\" in [[watch]]; "));
  EXPECT_TRUE(watch_refusal("max-error = 1").starts_with("4:1: unknown key \"max-error\" in [[watch]]; "));
}

TEST_F(Config, WrongShapes) {
  EXPECT_EQ(refusal(""), "1:1: there is no [[watch]]; add one for each directory to watch");
  EXPECT_EQ(refusal("[watch]\ndirectory = 'in'"), "1:1: watch must be an array of tables: [[watch]]");
  EXPECT_EQ(refusal("service = 3\n" + kWatch), "1:11: service must be a table: [service]");
  EXPECT_EQ(refusal("[[watch]]\noutput = 'out'"), "1:1: [[watch]] needs a directory");
  EXPECT_EQ(refusal("[[watch]]\ndirectory = 'in'"), "1:1: [[watch]] needs an output, a directory");
  EXPECT_TRUE(refusal("[service\n" + kWatch).starts_with("1:9: ")) << refusal("[service\n" + kWatch);
}

TEST_F(Config, WrongValuesOfTheService) {
  EXPECT_EQ(service_refusal("state = ''"), "2:9: state is empty, it must be a path");
  EXPECT_EQ(service_refusal("listen = 'unix:weir.sock'"), "2:10: listen is HOST:PORT; a Unix socket is control_socket");
  EXPECT_EQ(service_refusal("control_socket = '/" + std::string(103, 'x') + "'"),
            "2:18: control_socket is a path of 104 bytes, /" + std::string(103, 'x') + "; 103 can be used");
  EXPECT_EQ(service_refusal("log = 'weir.db'"),
            "1:1: two of state, log, port_file and control_socket are one file, " + (directory_ / "weir.db"));
  EXPECT_EQ(service_refusal("port_file = 'a'\ncontrol_socket = 'a'"),
            "1:1: two of state, log, port_file and control_socket are one file, " + (directory_ / "a"));
  EXPECT_EQ(service_refusal("jobs = 0"), "2:8: jobs is 0, it must be from 1 to 1024");
  EXPECT_EQ(service_refusal("jobs = 1.5"), "2:8: jobs is 1.5, it must be a whole number");
  EXPECT_EQ(service_refusal("history = '90d'"), "2:11: history is \"90d\", it must be a number");
  EXPECT_EQ(service_refusal("nice = -1"), "2:8: nice is -1, it must be from 0 to 19");
  EXPECT_EQ(service_refusal("io_class = 'slow'"),
            "2:12: io_class is \"slow\", it must be one of none, best-effort, idle");
  EXPECT_EQ(service_refusal("log_level = 'loud'"),
            "2:13: log_level is \"loud\", it must be one of trace, debug, info, warn, error, off");
  const std::string size = ", it must be a size such as 1073741824, \"64MiB\" or \"1.5GB\"";
  EXPECT_EQ(service_refusal("memory = 'much'"), "2:10: memory is \"much\"" + size);
  EXPECT_EQ(service_refusal("bandwidth = -1"), "2:13: bandwidth is -1" + size);
  EXPECT_EQ(service_refusal("bandwidth = '10Mb'"), "2:13: bandwidth is \"10Mb\"" + size);
  EXPECT_EQ(service_refusal("log_size = 1.5"), "2:12: log_size is 1.5" + size);
}

TEST_F(Config, MemoryTooLittleForAllJobs_IsRefused) {
  EXPECT_EQ(service_refusal("memory = '128MiB'"), "");
  EXPECT_EQ(service_refusal("memory = 134217727"),
            "2:10: memory is 128.0 MiB, too little for the daemon and jobs = 1; it must be at least 128.0 MiB");
  EXPECT_EQ(service_refusal("jobs = 16"),
            "2:8: memory is 1.0 GiB, too little for the daemon and jobs = 16; it must be at least 1.1 GiB");
  EXPECT_EQ(service_refusal("memory = 1"),
            "2:10: memory is 1 B, too little for the daemon and jobs = 1; it must be at least 128.0 MiB");
}

TEST_F(Config, ViewerMemory_IsAnEighthWhereThatLeavesEnough) {
  const auto of = [&](const std::string& keys) {
    return load("[service]\n" + keys + "\n[[watch]]\ndirectory = 'in'\noutput = 'out'\n").service.viewer_memory >> 20U;
  };
  EXPECT_EQ(of("memory = '2GiB'"), 256U);
  EXPECT_EQ(of("memory = '64GiB'"), 512U);
  EXPECT_EQ(of("memory = '1GiB'"), 192U) << "so that it can forecast";
  EXPECT_EQ(of("memory = '1GiB'\njobs = 12"), 192U);
  EXPECT_EQ(of("memory = '1023MiB'"), 0U) << "an eighth is less than a viewer needs";
  EXPECT_EQ(of("jobs = 14"), 0U) << "14 jobs of 64 MiB each leave 64 MiB";
  EXPECT_EQ(of("jobs = 13"), 128U);
  EXPECT_EQ(of("viewer_memory = 0"), 0U);
  EXPECT_EQ(of("viewer_memory = '700MiB'"), 700U);
  EXPECT_EQ(service_refusal("viewer_memory = '100MiB'"),
            "2:17: viewer_memory is 100.0 MiB, it must be at least 128.0 MiB, or 0 for no viewer");
  EXPECT_EQ(
      service_refusal("memory = '512MiB'\nviewer_memory = '400MiB'"),
      "2:10: memory is 512.0 MiB, too little for the daemon, viewer_memory = 400.0 MiB and jobs = 1; it must be at "
      "least 528.0 MiB");
}

TEST_F(Config, NoViewer_HasTheReasonOfItsDefault) {
  const auto of = [&](const std::string& keys) {
    return no_viewer_reason(load("[service]\n" + keys + "\n[[watch]]\ndirectory = 'in'\noutput = 'out'\n").service);
  };
  EXPECT_EQ(of("memory = '256MiB'"),
            "memory is 256.0 MiB, and below 1.0 GiB there is none by default; set viewer_memory = \"128MiB\" or give "
            "more memory");
  EXPECT_EQ(of("jobs = 14"),
            "memory is 1.0 GiB, and with a viewer each of 14 jobs would get too little of it; give more memory, or "
            "fewer jobs");
  EXPECT_EQ(of("memory = '256MiB'\nviewer_memory = 0"), "viewer_memory is 0 in the configuration");
}

TEST_F(Config, DeleteAfter_HasNoEffectWhereNothingIsDeleted) {
  const auto of = [&](const std::string& keys) {
    return load("[[watch]]\ndirectory = 'in'\noutput = 'out'\n" + keys).watches.front().unused_key();
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("source = 'delete-after-verify'\ndelete_after = 60\n"), "");
  for (const char* given : {"delete_after = 60\n", "delete_after = '10min'\nsource = 'keep'\n"}) {
    EXPECT_EQ(of(given),
              "delete_after has no effect, since nothing is deleted; set source = \"delete-after-verify\", or leave it "
              "out");
  }
}

TEST_F(Config, ListeningBeyondLoopback_NeedsAToken) {
  EXPECT_EQ(service_refusal("listen = '127.0.0.9:1'"), "");
  EXPECT_EQ(service_refusal("listen = 'localhost:1'"), "");
  for (const std::string address : {"0.0.0.0:8470", "[::]:8470", "10.1.2.3:8470"}) {
    EXPECT_EQ(service_refusal("listen = '" + address + "'"),
              "2:10: listen is " + address + ", which other machines may reach; add a token or token_file");
    EXPECT_EQ(service_refusal("listen = '" + address + "'\ntoken = 'secret'"), "");
  }
  EXPECT_EQ(service_refusal("listen = '8470'"),
            "2:10: \"8470\" is no address; write HOST:PORT, as 127.0.0.1:8470 or [::1]:8470");
  EXPECT_EQ(service_refusal("token = ''"), "2:9: the token is empty; openssl rand -hex 32 makes one");
  EXPECT_EQ(service_refusal("token = 'a b'"),
            "2:9: the token must be ASCII without spaces; openssl rand -hex 32 makes one");
}

TEST_F(Config, ATokenFromAFile) {
  const std::string file = directory_ / "token";
  const std::string service = "[service]\ntoken_file = 'token'\n";
  EXPECT_EQ(refusal(service + kWatch), "2:14: " + file + ": cannot read the token: No such file or directory");
  write_file(file, "s3cret\n");
  std::filesystem::permissions(file, std::filesystem::perms(0644));
  EXPECT_EQ(refusal(service + kWatch), "2:14: " + file + ": can be read by everybody; chmod o-r it");
  std::filesystem::permissions(file, std::filesystem::perms(0640));
  EXPECT_EQ(load(service + kWatch).service.token, "s3cret");
  EXPECT_EQ(refusal(service + "token = 'other'\n" + kWatch), "2:14: token and token_file exclude each other; give one");
  write_file(file, " \n");
  EXPECT_EQ(refusal(service + kWatch), "2:14: the token is empty; openssl rand -hex 32 makes one");
}

TEST_F(Config, OutputMount_IsTheOutputOrADirectoryAboveIt) {
  EXPECT_EQ(watch_refusal("output_mount = 'out'"), "");
  EXPECT_EQ(watch_refusal("output_mount = '/'"), "4:16: output_mount is /, which is always mounted; name another one");
  EXPECT_EQ(watch_refusal("output_mount = 'out/deep'"),
            cat("4:16: output_mount is ", directory_ / "out/deep", ", and the output ", directory_ / "out",
                " does not lie below it; name the directory at which its file system is mounted"));
}

TEST_F(Config, WrongValuesOfAWatch) {
  EXPECT_EQ(watch_refusal("complete = 'soon'"),
            "4:12: complete is \"soon\", it must be one of auto, close, rename, marker, size, stable");
  EXPECT_EQ(watch_refusal("complete = 'close'\nwatch = 'poll'"),
            "4:12: complete is close, which polling never sees; use stable, size or marker");
  EXPECT_EQ(watch_refusal("watch = 'eye'"), "4:9: watch is \"eye\", it must be one of auto, inotify, poll");
  EXPECT_EQ(watch_refusal("source = 'delete'"),
            "4:10: source is \"delete\", it must be one of keep, delete-after-verify");
  EXPECT_EQ(watch_refusal("settle = 0"), "4:10: settle is 0, it must be from 0.01 to 86400");
  EXPECT_EQ(watch_refusal("delete_after = '2y'"),
            "4:16: delete_after is \"2y\", it must be a number of seconds or a text such as \"90s\", \"10min\", \"2h\" "
            "or \"3d\"");
  EXPECT_EQ(watch_refusal("delete_after = true"),
            "4:16: delete_after is true, it must be a number of seconds or a text such as \"90s\", \"10min\", \"2h\" "
            "or \"3d\"");
  EXPECT_EQ(watch_refusal("settle = '2d'"), "4:10: settle is \"2d\", it must be from 0.01 to 86400 seconds");
  EXPECT_EQ(watch_refusal("recursive = 'yes'"), "4:13: recursive must be true or false");
  EXPECT_EQ(watch_refusal("include = '*.raw'"), "4:11: include must be an array of strings");
  EXPECT_EQ(watch_refusal("exclude = ['']"), "4:11: exclude has an empty pattern");
  EXPECT_EQ(watch_refusal("marker = ''"), "4:10: marker is \"\", it must be a suffix such as .done");
  EXPECT_EQ(watch_refusal("label = ''"), "4:9: label is empty");
}

TEST_F(Config, OutputNameThatFitsAllSources_IsRefused) {
  EXPECT_EQ(watch_refusal("name = '{stem}_a.nvdb'"), "");
  EXPECT_EQ(watch_refusal("name = 'a.nvdb'"),
            "4:8: name is \"a.nvdb\", which gives all sources one output; put {stem} in it");
  EXPECT_EQ(watch_refusal("name = '{stem}'"), "4:8: name is \"{stem}\", it must end with .nvdb");
  EXPECT_EQ(watch_refusal("name = '../{stem}.nvdb'"),
            "4:8: name is \"../{stem}.nvdb\", it must not have a slash; directories are named by output");
  EXPECT_EQ(watch_refusal("name = '{time}.nvdb'"),
            "4:8: {time} in an output's name is not known; there are {stem}, {dataset} and {step}");
}

TEST_F(Config, TokenFileThatMayNotBeRead_IsAnIoErrorAtItsKey) {
  const std::string file = unreadable_file();
  if (file.empty()) GTEST_SKIP() << "this system has no file that root may not read";
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { load("[service]\ntoken_file = '" + file + "'\n" + kWatch); }),
            path_ + ":2:14: " + file +
                ": cannot read: Permission denied; give this user the right to read it and to enter its directories");
}

TEST_F(Config, ConversionOptionsAreCheckedAsTheCommandDoes) {
  EXPECT_EQ(watch_refusal("rate = 'fast'"),
            "4:8: rate is \"fast\", it must be a positive number: dense float32 bytes / file bytes");
  EXPECT_EQ(watch_refusal("rate = 8\nlossless = true"),
            "5:12: size, rate, psnr, max_error and lossless exclude each other; give one");
  EXPECT_EQ(watch_refusal("brick = 16"),
            "4:9: brick 16 is for metric farthest, closest or median; sse chooses single leaves");
  EXPECT_EQ(watch_refusal("dims = [64, 64]"),
            "4:8: dims is \"64,64\", it must be X,Y,Z, three whole numbers of voxels");
  EXPECT_EQ(watch_refusal("spacing = '0,1,1'"),
            "4:11: spacing is \"0,1,1\", it must be x,y,z, three finite numbers above 0 in world units");
  EXPECT_EQ(watch_refusal("background = -5\norigin = [-1, 0, 2.5]\nnonfinite = 'keep'"), "");
}

TEST_F(Config, WatchConflict_IsReportedAtItsKey) {
  EXPECT_EQ(refusal("[[watch]]\ndirectory = 'in'\noutput = 'in'\n"),
            "3:10: " + (directory_ / "in") + " is watched and lies in the output " + (directory_ / "in") +
                ", so that results would be converted again; separate them, " + (directory_ / "in/nvdb") +
                " is a good output for instance");
  // Without a key to point at, the message points at the table.
  EXPECT_EQ(refusal(kWatch + kWatch), "4:1: there is a watch of the label \"" + (directory_ / "in") +
                                          "\" already; give this one a label of its own");
}

TEST_F(Config, FileThatCannotBeRead_IsNamedWithTheReason) {
  const auto message = [](const std::string& path) -> std::string {
    try {
      load_config(path);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
  };
  EXPECT_EQ(message(path_), path_ + ": cannot read: No such file or directory");
  EXPECT_EQ(message(directory_.path().string()), directory_.path().string() + ": cannot read: Is a directory");
}

}  // namespace
}  // namespace weir::config_test
