#include "tools/describe/man_page.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/tools/support/described_app.h"

namespace weir::man_page_test {
namespace {

const std::string kExitStatus =
    ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\ninternal fault\n.TP\n2\nusage: a wrong option or argument\n.TP\n3\nbad "
    "input, or none\n.TP\n4\nthe budget cannot be met\n.TP\n5\ncannot read, write or connect: disk full, permission, "
    "no such directory, no service at the address, a plug\\-in of another build\n.TP\n129\ninterrupted: the terminal "
    "was closed (SIGHUP)\n.TP\n130\ninterrupted: SIGINT or SIGTERM (weir watch and weir view end with 0)\n";

const std::string kEnvironment = R"(.SH ENVIRONMENT
.TP
WEIR_TOKEN
token of the service, for weir status, jobs, retry, cancel, pause and resume, where neither \-\-token\-file nor the file of \-\-config has one
.TP
WEIR_DRIVERS
folder of the plug\-ins (weir_hdf5.so and others) instead of lib/weir, an absolute path
.TP
TMPDIR
directory for temporary files of weir view and of weir render \-\-volume dense; default: /tmp
.TP
HDF5_PLUGIN_PATH
directories with the plug\-ins of HDF5's filters, which the HDF5 library reads
.TP
HDF5_VDS_PREFIX, HDF5_EXTFILE_PREFIX
directory in which the files of virtual and of external datasets are looked for first
.TP
STATE_DIRECTORY
directory of weir watch's state file, where its configuration names none; systemd sets it
)";

TEST(ManPage, OfTheCommandItself) {
  test::DescribedApp described;
  const auto commands = describe_commands(described.app);
  EXPECT_EQ(man_page_name(commands[0]), "weir");
  EXPECT_EQ(man_page(commands[0], commands, "9.8.7"), R"(.TH "WEIR" 1 "" "weir 9.8.7" "User Commands"
.SH NAME
weir \- Lets water through
.SH SYNOPSIS
\fBweir\fR [\fIOPTION\fR]... \fICOMMAND\fR [\fIARGUMENT\fR]...
.SH COMMANDS
.TP
\fBopen\fR
Opens a gate: it's quick
.TP
\fBmeasure\fR
Measures the level
.SH OPTIONS
.TP
\fB\-h\fR, \fB\-\-help\fR
Print this help message and exit
.TP
\fB\-\-version\fR
Display program version information and exit
.SH EXAMPLES
Make a volume, convert it, check the result and look at it:
.PP
.nf
.RS
weir sample cloud \-\-dims 128,128,128 \-o cloud_128x128x128_float32.raw
weir convert cloud_128x128x128_float32.raw \-o cloud.nvdb
weir verify cloud.nvdb
weir render cloud.nvdb \-o cloud.png
.RE
.fi
)" + kExitStatus + kEnvironment + R"(.SH SEE ALSO
\fBweir\-open\fR(1),
\fBweir\-measure\fR(1)
)");
}

TEST(ManPage, OfASubcommand) {
  test::DescribedApp described;
  const auto commands = describe_commands(described.app);
  EXPECT_EQ(man_page_name(commands[1]), "weir-open");
  EXPECT_EQ(man_page(commands[1], commands, "9.8.7"), R"(.TH "WEIR\-OPEN" 1 "" "weir 9.8.7" "User Commands"
.SH NAME
weir\-open \- Opens a gate: it's quick
.SH SYNOPSIS
\fBweir open\fR \fB\-w\fR \fIMETRES\fR [\fIOPTION\fR]... \fIgate\fR...
.SH ARGUMENTS
.TP
\fIgate\fR
which, see below
.SH OPTIONS
.TP
\fB\-h\fR, \fB\-\-help\fR
Print this help message and exit
.TP
\fB\-w\fR, \fB\-\-width\fR \fIMETRES\fR
of the gap \e in m
.TP
\fB\-\-pace\fR \fBslow\fR|\fBfast\fR
how fast; default: slow
.TP
\fB\-\-count\fR \fIN\fR
\&.of [times]
.TP
\fB\-\-quiet\fR
says nothing
.SS Place
.TP
\fB\-\-side\fR \fBleft\fR|\fBright\fR
\&
.SH NOTES
.nf
Gates:
  .upper  'first'
.fi
)" + kExitStatus + R"(.SH SEE ALSO
\fBweir\fR(1),
\fBweir\-measure\fR(1)
)");
}

// The real command line has a page for every command that --help lists. The formatter must not complain of any page.
TEST(ManPage, OfEveryCommand) {
  TemporaryDirectory directory;
  ASSERT_EQ(run_weir({"man", directory.path()}).exit_code, 0);
  const std::vector<std::string> pages = list_directory(directory.path());
  const std::string help = run_weir({"--help"}).out;
  std::size_t listed = 0;
  for (std::size_t at = help.find("Subcommands:"); (at = help.find("\n  ", at)) != std::string::npos; ++at) {
    const std::string name = help.substr(at + 3, help.find(' ', at + 3) - at - 3);
    if (name.empty()) continue;
    ++listed;
    const std::string page = cat("weir-", name, ".1");
    ASSERT_NE(std::find(pages.begin(), pages.end(), page), pages.end()) << name;
    EXPECT_NE(read_file(directory / page).find(cat(".SH EXAMPLES\n")), std::string::npos) << name;
  }
  EXPECT_EQ(pages.size(), listed + 2) << "weir.1 and weir.toml.5";
  if (run_command({"sh", "-c", "command -v groff"}).exit_code != 0) GTEST_SKIP() << "groff is not installed";
  for (const std::string& page : pages) {
    const CommandResult read = run_command({"groff", "-man", "-ww", "-z", directory / page});
    EXPECT_EQ(read.exit_code, 0);
    EXPECT_EQ(read.err, "") << page;
  }
}

TEST(ManPage, UnwritableDirectory_IsRefused) {
  const CommandResult result = run_weir({"man", "/proc"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, "weir: /proc/weir.1: cannot be written; name a directory that can\n");
}

TEST(ManPage, MissingDirectory_IsSaidWithHowToMakeIt) {
  const TemporaryDirectory directory;
  const std::string pages = directory / "my pages";
  const CommandResult result = run_weir({"man", pages});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, "weir: " + pages + ": this directory does not exist; make it: mkdir -p '" + pages + "'\n");
}

}  // namespace
}  // namespace weir::man_page_test
