#include "daemon/config/load_config.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include "compressor/options/conversion_request.h"
#include "daemon/config/config_names.h"
#include "daemon/config/duration.h"
#include "daemon/config/own_files.h"
#include "daemon/config/regular_file.h"
#include "daemon/config/token_file.h"
#include "daemon/config/watch_conflicts.h"
#include "daemon/config/watch_options.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/base/toml_reader.h"
#include "format/io/refused_open.h"
#include "ingest/series_names.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostConfigBytes = 16 << 20;  // a thousand watches take less than one MiB

/// Reads one table of the configuration file into the daemon's own types.
class ConfigReader {
 public:
  ConfigReader(const toml::table& table, std::string name, const std::string& path)
      : toml(table, std::move(name), path), directory_(fs::path(path).parent_path()) {}

  template <typename T, std::size_t N, typename V>
  void choose(std::string_view key, V& value, const Choices<T, N>& choices) {
    std::string text;
    if (!toml.read(key, text)) return;
    std::string names;
    for (const auto& [name, choice] : choices) {
      if (name == text) {
        value = V(choice);
        return;
      }
      names += cat(names.empty() ? "" : ", ", name);
    }
    refuse(key, cat(key, " is \"", text, "\", it must be one of ", names));
  }

  /// Reads a size: a whole number of bytes or a text such as "1GiB".
  void read_bytes(std::string_view key, std::uint64_t& value) {
    const toml::node* node = toml.find(key);
    if (node == nullptr) return;
    const auto* text = node->as_string();
    const auto* number = node->as_integer();
    const auto bytes = text != nullptr     ? parse_bytes(text->get())
                       : number != nullptr ? parse_bytes(std::to_string(number->get()))
                                           : std::nullopt;
    if (!bytes) {
      toml.fail(*node,
                cat(key, " is ", value_found(*node), ", it must be a size such as 1073741824, \"64MiB\" or \"1.5GB\""));
    }
    value = *bytes;
  }

  /// Reads a number of seconds or a text such as "10min". Returns whether the key is there.
  bool read_seconds(std::string_view key, double& value, Bounds bounds) {
    const toml::node* node = toml.find(key);
    if (node == nullptr) return false;
    if (!node->is_string() && !node->is_number()) fail_duration(*node, key);
    if (node->is_number()) return toml.read(key, value, bounds);
    const std::string& text = node->as_string()->get();
    const std::optional<double> seconds = parse_duration_s(text);
    if (!seconds) fail_duration(*node, key);
    if (*seconds < bounds.low || *seconds > bounds.high) {
      toml.fail(*node, cat(key, " is \"", text, "\", it must be from ", bounds.low, " to ", bounds.high, " seconds"));
    }
    value = *seconds;
    return true;
  }

  /// Reads a path and makes it absolute and normal, without a slash at its end. Returns whether the key is there.
  bool read_path(std::string_view key, std::string& value) {
    std::string text;
    if (!toml.read(key, text)) return false;
    if (text.empty()) refuse(key, cat(key, " is empty, it must be a path"));
    fs::path path = (directory_ / text).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    value = path.string();
    return true;
  }

  [[noreturn]] void refuse(std::string_view key, const std::string& message) { toml.fail(*toml.find(key), message); }

  TomlReader toml;

 private:
  [[noreturn]] void fail_duration(const toml::node& node, std::string_view key) {
    toml.fail(node, cat(key, " is ", value_found(node),
                        ", it must be a number of seconds or a text such as \"90s\", \"10min\", \"2h\" or \"3d\""));
  }

  fs::path directory_;
};

// Returns the token of the file. Throws at the key token_file, but with the kind of the file's error: a file that this
// user may not read does not make the configuration wrong.
std::string token_of_file(ConfigReader& reader, const std::string& path) {
  try {
    return read_token_file(path);
  } catch (const Error& error) {
    try {
      reader.refuse("token_file", error.what());
    } catch (const Error& placed) {
      throw Error(error.kind(), placed.message(), error.system_failure());
    }
  }
}

void read_token(ConfigReader& reader, ServiceConfig& service) {
  const bool from_file = reader.read_path("token_file", service.token_file);
  const char* key = from_file ? "token_file" : "token";
  if (reader.toml.read("token", service.token) && from_file) {
    reader.refuse("token_file", "token and token_file exclude each other; give one");
  }
  if (from_file) service.token = token_of_file(reader, service.token_file);
  if (!from_file && reader.toml.find("token") == nullptr) return;
  if (const std::string fault = token_fault(service.token); !fault.empty()) reader.refuse(key, fault);
}

void read_control_socket(ConfigReader& reader, ServiceConfig& service) {
  if (!reader.read_path("control_socket", service.control_socket)) return;
  const std::size_t bytes = service.control_socket.size();
  if (bytes > kLongestSocketPath) {
    reader.refuse("control_socket", cat("control_socket is a path of ", bytes, " bytes, ", service.control_socket, "; ",
                                        kLongestSocketPath, " can be used"));
  }
}

void read_listen(ConfigReader& reader, const toml::table& table, ServiceConfig& service) {
  std::string address;
  if (reader.toml.read("listen", address)) {
    try {
      service.listen = parse_listen_address(address);
    } catch (const Error& error) {
      reader.refuse("listen", error.what());
    }
    if (service.listen.is_unix()) reader.refuse("listen", "listen is HOST:PORT; a Unix socket is control_socket");
  }
  read_token(reader, service);
  if (!is_loopback(service.listen.host) && service.token.empty()) {
    reader.toml.fail(*table.get("listen"), cat("listen is ", service.listen.text(),
                                               ", which other machines may reach; add a token or token_file"));
  }
}

void read_viewer_memory(ConfigReader& reader, ServiceConfig& service) {
  if (reader.toml.find("viewer_memory") == nullptr) {
    service.viewer_memory = standard_viewer_memory(service, kLeastMemory);
    service.is_standard_viewer = true;
    return;
  }
  reader.read_bytes("viewer_memory", service.viewer_memory);
  if (service.viewer_memory != 0 && service.viewer_memory < kLeastViewerMemory) {
    reader.refuse("viewer_memory",
                  cat("viewer_memory is ", format_bytes(service.viewer_memory), ", it must be at least ",
                      format_bytes(kLeastViewerMemory), ", or 0 for no viewer"));
  }
}

// systemd gives a service a writable directory, STATE_DIRECTORY. The configuration's directory, /etc/weir, is not one.
std::string standard_state(const std::string& path) {
  const char* const given = std::getenv("STATE_DIRECTORY");  // several directories have colons between them
  const std::string own = given == nullptr ? "" : split(given, ':').front();
  return ((own.starts_with('/') ? fs::path(own) : fs::path(path).parent_path()) / "weir.db").string();
}

ServiceConfig read_service(const toml::table& table, const std::string& path) {
  ServiceConfig service;
  service.state = standard_state(path);
  ConfigReader reader(table, "[service]", path);
  reader.read_path("state", service.state);
  read_listen(reader, table, service);
  reader.read_path("port_file", service.port_file);
  read_control_socket(reader, service);
  reader.read_bytes("memory", service.memory);
  reader.toml.read("jobs", service.jobs, {1, 1024});
  read_viewer_memory(reader, service);
  reader.toml.read("threads", service.threads, {0, 4096});
  reader.toml.read("nice", service.nice, {0, 19});
  reader.choose("io_class", service.io_class, kIoClasses);
  reader.read_bytes("bandwidth", service.bandwidth);
  reader.read_path("work_dir", service.work_dir);
  reader.read_seconds("grace", service.grace_s, {0, 86400});
  reader.toml.read("history", service.history_days, {0, 36500});
  reader.read_path("log", service.log_file);
  reader.choose("log_level", service.log_level, kLogLevels);
  reader.read_bytes("log_size", service.log_size);
  reader.toml.read("log_files", service.log_files, {1, 1000});
  reader.toml.finish();
  if (job_memory(service) < kLeastMemory) {
    const toml::node* place = table.get("memory") != nullptr ? table.get("memory") : table.get("jobs");
    const std::uint64_t least =
        kDaemonMemory + service.viewer_memory + static_cast<std::uint64_t>(service.jobs) * kLeastMemory;
    const std::string viewer =
        service.viewer_memory == 0 ? "" : cat(", viewer_memory = ", format_bytes(service.viewer_memory));
    reader.toml.fail(place != nullptr ? *place : table,
                     cat("memory is ", format_bytes(service.memory), ", too little for the daemon", viewer,
                         " and jobs = ", service.jobs, "; it must be at least ", format_bytes(least)));
  }
  return service;
}

void check_patterns(ConfigReader& reader, std::string_view key, const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns) {
    if (pattern.empty()) reader.refuse(key, cat(key, " has an empty pattern"));
  }
}

void check_name(ConfigReader& reader, const std::string& name) {
  try {
    step_name(name, {});
  } catch (const Error& error) {
    reader.refuse("name", error.what());
  }
  if (name.find('/') != std::string::npos) {
    reader.refuse("name", cat("name is \"", name, "\", it must not have a slash; directories are named by output"));
  }
  if (name.find("{stem}") == std::string::npos) {
    reader.refuse("name", cat("name is \"", name, "\", which gives all sources one output; put {stem} in it"));
  }
  if (!name.ends_with(".nvdb")) reader.refuse("name", cat("name is \"", name, "\", it must end with .nvdb"));
}

WatchConfig read_watch(const toml::table& table, const std::string& path) {
  WatchConfig watch;
  ConfigReader reader(table, "[[watch]]", path);
  if (!reader.read_path("directory", watch.directory)) reader.toml.fail(table, "[[watch]] needs a directory");
  if (!reader.read_path("output", watch.output)) reader.toml.fail(table, "[[watch]] needs an output, a directory");
  reader.read_path("output_mount", watch.output_mount);
  if (watch.output_mount == "/") {
    reader.refuse("output_mount", "output_mount is /, which is always mounted; name another one");
  }
  if (!watch.output_mount.empty() && !is_within(watch.output, watch.output_mount)) {
    reader.refuse("output_mount",
                  cat("output_mount is ", watch.output_mount, ", and the output ", watch.output,
                      " does not lie below it; name the directory at which its file system is mounted"));
  }
  watch.label = watch.directory;
  if (reader.toml.read("label", watch.label) && watch.label.empty()) reader.refuse("label", "label is empty");
  reader.toml.read("recursive", watch.recursive);
  if (reader.toml.read("name", watch.name)) check_name(reader, watch.name);
  reader.toml.read("include", watch.include);
  reader.toml.read("exclude", watch.exclude);
  check_patterns(reader, "include", watch.include);
  check_patterns(reader, "exclude", watch.exclude);
  reader.choose("complete", watch.complete, kCompletions);
  if (reader.toml.read("marker", watch.marker) &&
      (watch.marker.empty() || watch.marker.find('/') != std::string::npos)) {
    reader.refuse("marker", cat("marker is \"", watch.marker, "\", it must be a suffix such as .done"));
  }
  reader.read_seconds("settle", watch.settle_s, {0.01, 86400});
  reader.choose("watch", watch.watch, kWatchMethods);
  reader.read_seconds("poll_interval", watch.poll_interval_s, {0.01, 86400});
  if (watch.watch == WatchMethod::poll && watch.complete == Completion::close) {
    reader.refuse("complete", "complete is close, which polling never sees; use stable, size or marker");
  }
  reader.choose("priority", watch.priority, kPriorities);
  reader.choose("source", watch.source, kAfterDone);
  watch.gives_delete_after = reader.read_seconds("delete_after", watch.delete_after_s, {0, 31'536'000});
  reader.choose("follow", watch.follow, kFollow);
  reader.toml.read("thumbnails", watch.thumbnails);
  watch.convert_options = read_watch_options(reader.toml, table);
  reader.toml.finish();
  return watch;
}

}  // namespace

DaemonConfig load_config(const std::string& path) {
  DaemonConfig config;
  config.path = fs::absolute(path).lexically_normal().string();
  const toml::table document = parse_toml(read_regular_file(config.path, kMostConfigBytes), config.path);
  TomlReader reader(document, "the configuration", config.path);
  const toml::node* service = reader.find("service");
  if (service != nullptr && !service->is_table()) reader.fail(*service, "service must be a table: [service]");
  const toml::table defaults;
  config.service = read_service(service != nullptr ? *service->as_table() : defaults, config.path);
  const toml::node* watches = reader.find("watch");
  reader.finish();
  if (watches == nullptr) reader.fail(document, "there is no [[watch]]; add one for each directory to watch");
  if (!watches->is_array_of_tables()) reader.fail(*watches, "watch must be an array of tables: [[watch]]");
  const toml::array& tables = *watches->as_array();
  for (const toml::node& table : tables) config.watches.push_back(read_watch(*table.as_table(), config.path));
  if (const auto conflict = find_conflict(config.watches)) {
    const toml::table& table = *tables.get(conflict->watch)->as_table();
    const toml::node* node = table.get(conflict->key);
    reader.fail(node != nullptr ? *node : table, conflict->message);
  }
  if (const auto conflict = find_own_file_conflict(config)) {
    const toml::node* table = service != nullptr ? service : &document;
    const toml::node* key = service != nullptr ? service->as_table()->get(conflict->key) : nullptr;
    reader.fail(key != nullptr ? *key : *table, conflict->message);
  }
  exclude_own_files(config);
  return config;
}

}  // namespace weir
