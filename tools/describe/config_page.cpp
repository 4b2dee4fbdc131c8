#include "tools/describe/config_page.h"

#include "compressor/options/conversion_request.h"
#include "format/base/message.h"
#include "format/base/text.h"
#include "tools/describe/man_text.h"

namespace weir {
namespace {

constexpr ConfigKey kConfigKeys[] = {
    {"service", "state", "weir.db",
     "SQLite database of all jobs, one for each service; by default in the unit's state directory, /var/lib/weir/NAME, "
     "or "
     "beside the configuration"},
    {"service", "listen", "\"127.0.0.1:8470\"",
     "HOST:PORT of page, API and metrics, another one for each service of a machine; port 0 takes a free one. Anything "
     "but "
     "loopback needs a token"},
    {"service", "control_socket", "none", "Unix socket at which alone jobs can be changed, mode 0660"},
    {"service", "port_file", "none", "the port that was bound is written there"},
    {"service", "token", "none", "bearer token that requests for data must send"},
    {"service", "token_file", "none", "file with the token, not readable by everybody"},
    {"service", "memory", "\"1GiB\"", "of the service, 64 MiB, all jobs and the viewer together"},
    {"service", "viewer_memory", "an eighth of memory",
     "of it for the viewer of results, from 128 MiB on; 0: there is none. By default 192 MiB at least and 512 MiB at "
     "most; as little as 128 MiB where the jobs would get too little beside 192; and 0 where they would even so or "
     "memory is below 1 GiB"},
    {"service", "jobs", "1", "conversions at once"},
    {"service", "threads", "0", "of each job; 0: all of the machine's that the memory holds"},
    {"service", "nice", "0", "of the jobs, 0 to 19"},
    {"service", "io_class", "\"none\"", "of the jobs: none, best-effort or idle"},
    {"service", "bandwidth", "0", "bytes a second that all conversions together may read and write; 0: no limit"},
    {"service", "work_dir", "beside each output", "where conversions spill; not on a memory file system"},
    {"service", "grace", "30", "seconds that running jobs are given after SIGTERM"},
    {"service", "history", "90",
     "a number of days, no text, for which done and cancelled jobs are kept when their sources are gone"},
    {"service", "log", "standard error", "log file"},
    {"service", "log_level", "\"info\"", "trace, debug, info, warn, error or off"},
    {"service", "log_size", "\"10MiB\"", "at which the log file is rotated; 0: never"},
    {"service", "log_files", "5", "rotated files that are kept"},
    {"watch", "directory", "", "that is watched; need not exist yet"},
    {"watch", "output", "", "where results go"},
    {"watch", "output_mount", "none",
     "directory at which the file system of the output is mounted; jobs wait while nothing is mounted there"},
    {"watch", "label", "the directory", "name in state, log and metrics"},
    {"watch", "recursive", "false", "watch what is below, too"},
    {"watch", "include", "names of known formats",
     "globs of the sources; without any, a .raw file is one only if it is named NAME_XxYxZ_TYPE.raw or dims or type is "
     "set, and a .nvdb file is none"},
    {"watch", "exclude", "none", "globs of what is no source"},
    {"watch", "name", "\"{stem}.nvdb\"", "of the outputs, with {stem}, {dataset} and {step}"},
    {"watch", "complete", "\"auto\"", "when a file is whole: close, rename, marker, size, stable or auto"},
    {"watch", "marker", "\".done\"", "suffix of the marker"},
    {"watch", "settle", "2", "seconds without a change"},
    {"watch", "watch", "\"auto\"",
     "auto, inotify or poll: how changes are seen; auto: inotify where the file system tells of all, else poll"},
    {"watch", "poll_interval", "1", "seconds"},
    {"watch", "priority", "\"oldest\"", "oldest or newest: which file is converted first"},
    {"watch", "source", "\"keep\"",
     "keep or delete-after-verify: what becomes of a source when its outputs are verified"},
    {"watch", "delete_after", "600", "seconds between the end of a job and the deletion of its source"},
    {"watch", "follow", "\"inside\"",
     "inside or anywhere: where files may lie that a source names; inside: in the directory and below"},
    {"watch", "thumbnails", "true", "a picture beside each output"},
};

std::string config_entry(std::string_view key, std::string_view standard, const std::string& text) {
  const std::string value = standard.empty() ? "" : cat("; default: ", standard);
  return cat(".TP\n", man_bold(std::string(key)), '\n', man_escaped(text + value), '\n');
}

std::string entries_of(std::string_view table) {
  std::string page;
  for (const ConfigKey& key : kConfigKeys) {
    if (key.table == table) page += config_entry(key.key, key.standard, std::string(key.text));
  }
  return page;
}

std::string conversion_entries() {
  std::string page;
  for (const OptionRow& row : watch_options()) {
    page += config_entry(key_wording({std::string(row.key), {}}), row.standard, row.meaning());
  }
  return page;
}

constexpr std::string_view kConfigExample = R"([service]
listen = "127.0.0.1:8470"
memory = "2GiB"

[[watch]]
directory = "/scratch/run42"
output = "/scratch/run42/nvdb"
rate = 8
missing_policy = "background"
)";

}  // namespace

std::span<const ConfigKey> config_keys() { return kConfigKeys; }

std::string config_page(const std::string& version) {
  std::string page = cat(".TH \"WEIR.TOML\" 5 \"\" \"weir ", man_escaped(version), "\" \"File Formats\"\n");
  page += ".SH NAME\nweir.toml \\- what weir watch converts, and how\n";
  page += cat(".SH SYNOPSIS\n", man_bold("/etc/weir/NAME.toml"), '\n');
  page += ".SH DESCRIPTION\n" +
          man_escaped(
              "A TOML file that weir watch is given; the unit weir@NAME.service reads /etc/weir/NAME.toml. It has "
              "one table [service], which may be missing, and a table [[watch]] for each directory. Unknown keys "
              "and wrong values are errors with line and column. Relative paths are relative to the file. Sizes "
              "are numbers of bytes or text such as \"512MiB\", durations numbers of seconds or text such as "
              "\"10min\". weir watch --check says what a file asks for, and "
              "whether the user that runs it may write where it says.\n");
  page += cat(".SH [service]\n", entries_of("service"), ".SH [[watch]]\n", entries_of("watch"));
  page += ".SS Conversion\n" + man_escaped("The options of weir convert, with _ for -.\n") + conversion_entries();
  page += cat(".SH EXAMPLES\n.nf\n", man_escaped(std::string(kConfigExample)), ".fi\n");
  page += cat(".SH FILES\n.TP\n", man_bold("/etc/weir/example.toml"), "\nto be copied to NAME.toml\n");
  return page + cat(".SH SEE ALSO\n", man_bold("weir-watch"), "(1),\n", man_bold("weir-status"), "(1)\n");
}

}  // namespace weir
