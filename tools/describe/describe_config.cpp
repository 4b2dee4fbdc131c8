#include "tools/describe/describe_config.h"
#include "daemon/config/config_names.h"

#include <filesystem>
#include <sstream>
#include <string_view>
#include <vector>

#include "daemon/watch/file_system_kind.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/mount_table.h"

namespace weir {
namespace {

void say(std::ostream& out, const char* name, const std::string& value) {
  out << "  " << name << std::string(12 - std::string_view(name).size(), ' ') << value << '\n';
}

std::string joined(const std::vector<std::string>& words, const char* separator, const char* none) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text.empty() ? none : text;
}

void describe(std::ostream& out, const ServiceConfig& service) {
  out << "service\n";
  say(out, "state", service.state);
  say(out, "listen", cat(service.listen.text(), service.token.empty() ? "" : ", with a token"));
  if (!service.control_socket.empty()) say(out, "control", service.control_socket);
  if (!service.port_file.empty()) say(out, "port_file", service.port_file);
  say(out, "memory",
      cat(format_bytes(service.memory), ", ", format_bytes(job_memory(service)), " for each of ", service.jobs,
          service.jobs == 1 ? " job" : " jobs"));
  say(out, "viewer",
      service.viewer_memory == 0 ? cat("none: ", no_viewer_reason(service))
                                 : cat(format_bytes(service.viewer_memory), " of it"));
  say(out, "jobs",
      cat(service.threads == 0 ? "all" : std::to_string(service.threads), " threads each, nice ", service.nice,
          ", I/O class ", io_class_name(service.io_class)));
  if (service.bandwidth != 0) say(out, "bandwidth", cat(format_bytes(service.bandwidth), "/s"));
  say(out, "work_dir", service.work_dir.empty() ? "a hidden directory beside each output" : service.work_dir);
  say(out, "grace", cat(service.grace_s, " s"));
  say(out, "history", cat(service.history_days, " days"));
  say(out, "log", cat(service.log_file.empty() ? "stderr" : service.log_file, ", level ", service.log_level));
}

// Returns the watch method that will be used, as far as it is known now.
std::string watch_method(const WatchConfig& watch) {
  const std::string poll = cat("polling every ", watch.poll_interval_s, " s");
  if (watch.watch == WatchMethod::poll) return poll;
  if (watch.watch == WatchMethod::inotify) return "inotify";
  try {
    const FileSystemKind kind = file_system_kind(watch.directory);
    return cat("auto: ", kind.sees_all_changes ? "inotify" : poll, ", as it lies on ", kind.name);
  } catch (const Error&) {
    return cat("auto: inotify or ", poll, ", by its file system");
  }
}

// Returns what a watch without include patterns takes.
std::string default_include(const WatchConfig& watch) {
  return cat("names of known formats; ", watch.takes_any_raw() ? "any .raw" : ".raw only as NAME_XxYxZ_TYPE.raw",
             "; .nvdb only if named");
}

void describe(std::ostream& out, const WatchConfig& watch) {
  std::error_code ignored;
  out << "watch \"" << watch.label << "\"\n";
  say(out, "directory",
      cat(watch.directory, watch.recursive ? ", and below" : "",
          std::filesystem::is_directory(watch.directory, ignored) ? "" : ", which is not there yet"));
  say(out, "include", watch.include.empty() ? default_include(watch) : joined(watch.include, " ", ""));
  if (!watch.exclude.empty()) say(out, "exclude", joined(watch.exclude, " ", ""));
  for (const std::string& path : watch.excluded_paths) say(out, "never", path);
  for (const NumberedFiles& files : watch.excluded_numbers) {
    say(out, "never", cat(files.before, 'N', files.after, files.any_after ? "..." : "", ", N any number"));
  }
  say(out, "output", cat(watch.output, '/', watch.name.empty() ? "{stem}.nvdb" : watch.name));
  if (const std::string& mount = watch.output_mount; !mount.empty()) {
    say(out, "mount", cat(mount, is_mounted(mount) ? "" : ", where no file system is mounted now"));
  }
  say(out, "thumbnails", watch.thumbnails ? "yes" : "no");
  say(out, "watch", watch_method(watch));
  say(out, "complete",
      watch.complete == Completion::marker
          ? cat("marker ", watch.marker)
          : cat(completion_name(watch.complete), ", settled after ", watch.settle_s, " s"));
  say(out, "priority", std::string(priority_name(watch.priority)));
  const bool deletes = watch.source == AfterDone::delete_after_verify;
  say(out, "source",
      cat(after_done_name(watch.source), deletes ? cat(", ", watch.delete_after_s, " s after its job") : ""));
  if (const std::string unused = watch.unused_key(); !unused.empty()) say(out, "warning", unused);
  if (deletes && !says_when_done(watch.complete)) {
    say(out, "warning",
        "a writer that pauses may look like one that is done; complete = \"rename\" or \"marker\" tells");
  }
  for (const char* option : {"dataset", "index", "roi"}) {
    if (deletes && watch.convert_option(option)) {
      say(out, "warning", cat("what ", option, " leaves out of a source is deleted with it"));
    }
  }
  say(out, "follow", watch.follow == Follow::inside ? "what sources name, in the directory and below" : "anywhere");
  say(out, "convert", joined(watch.convert_options, " ", "as weir convert does by default"));
}

}  // namespace

std::string describe_config(const DaemonConfig& config) {
  std::ostringstream out;
  describe(out, config.service);
  for (const WatchConfig& watch : config.watches) describe(out, watch);
  return out.str();
}

}  // namespace weir
