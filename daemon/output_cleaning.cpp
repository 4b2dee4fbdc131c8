#include "daemon/output_cleaning.h"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>

#include "compressor/journal.h"
#include "daemon/file_identity.h"
#include "format/descriptor.h"
#include "format/error.h"
#include "format/file_system.h"
#include "format/text.h"

namespace weir {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// An interrupted conversion that nobody continues; it may hold as much disk as its result.
constexpr std::chrono::hours kKeptFor{7 * 24};

constexpr std::string_view kWork = ".nvdb.work";
constexpr std::string_view kPrevious = ".nvdb.json.previous";

bool is_partial(std::string_view name) {
  return name.ends_with(".nvdb.partial") || name.ends_with(".nvdb.json.partial") ||
         (name.starts_with('.') && name.ends_with(".partial") && name.find(".nvdb.png.") != std::string_view::npos);
}

// The file's lock is its writer's: taking it means that nobody writes.
bool is_written(const fs::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  return file && ::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

// Spill files have no names where the file system can do that; elsewhere a kill may come between their making and
// the removal of the name.
void remove_spills(const fs::path& work) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(work, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("spill") && name.size() == 11) fs::remove(entry.path(), ignored);
  }
}

// Whether the journal says of a source that it is still what it was.
bool is_of_this_source(const Checkpoint& checkpoint) {
  const auto entry = [&](const char* name) {
    const auto at = checkpoint.identity.find(name);
    return at == checkpoint.identity.end() ? std::string() : at->second;
  };
  const auto source = identify(entry("source"));
  return source && cat(source->bytes) == entry("source bytes") &&
         cat(source->mtime_ns) == entry("source modified (ns)");
}

class Cleaner {
 public:
  explicit Cleaner(std::chrono::milliseconds patience) : deadline_(Clock::now() + patience) {}

  void clean(const fs::directory_entry& entry) {
    const fs::path& path = entry.path();
    const std::string name = path.filename().string();
    std::error_code error;
    if (is_partial(name) && entry.is_regular_file(error)) {
      wait_for_writer(path) ? remove(path) : leave(path, "another process is writing it");
    } else if (name.ends_with(kPrevious) && entry.is_regular_file(error)) {
      restore(path);
    } else if (name.starts_with('.') && name.ends_with(kWork) && entry.is_directory(error)) {
      clean_work(path, path.parent_path() / name.substr(1, name.size() - 1 - std::string_view(".work").size()));
    }
  }

  CleaningReport report;

 private:
  bool wait_for_writer(const fs::path& path) const {
    while (is_written(path)) {
      if (Clock::now() >= deadline_) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }

  void clean_work(const fs::path& work, const fs::path& output) {
    if (!wait_for_writer(output.string() + ".partial")) return;
    try {
      const std::optional<Checkpoint> interrupted = read_journal(*files_, output);
      std::error_code ignored;
      const bool old = fs::file_time_type::clock::now() - fs::last_write_time(work, ignored) > kKeptFor;
      if (interrupted && !old && is_of_this_source(*interrupted)) return;
      remove_leftovers(*files_, output);
    } catch (const Error& error) {
      leave(work, error.what());
      return;
    }
    remove_spills(work);
    remove(work);
  }

  void remove(const fs::path& path) {
    std::error_code error;
    if (fs::remove(path, error)) report.removed.push_back(path.string());
    if (error) leave(path, error.message());
  }

  // The old record of an overwritten volume: see the numbered steps in format/output_files.cpp.
  void restore(const fs::path& path) {
    const fs::path record = fs::path(path).replace_extension();  // without .previous
    std::error_code error;
    if (fs::exists(record, error)) {
      remove(path);
    } else {
      fs::rename(path, record, error);
      if (error) leave(path, error.message());
    }
  }

  void leave(const fs::path& path, const std::string& reason) {
    report.left.push_back(cat(path.string(), ": ", reason));
  }

  Clock::time_point deadline_;
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

}  // namespace

CleaningReport clean_outputs(const std::string& directory, bool recursive, std::chrono::milliseconds patience) {
  Cleaner cleaner(patience);
  // Listed first: what is removed while a directory is read may be listed or not.
  std::vector<fs::directory_entry> entries;
  std::error_code error;
  const auto options = fs::directory_options::skip_permission_denied;
  if (recursive) {
    for (auto at = fs::recursive_directory_iterator(directory, options, error); !error && at != end(at);
         at.increment(error)) {
      entries.push_back(*at);
    }
  } else {
    for (auto at = fs::directory_iterator(directory, options, error); !error && at != end(at); at.increment(error)) {
      entries.push_back(*at);
    }
  }
  std::erase_if(entries, [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return !is_partial(name) && !name.ends_with(kPrevious) && !name.ends_with(kWork);
  });
  std::sort(entries.begin(), entries.end());
  for (const fs::directory_entry& entry : entries) cleaner.clean(entry);
  return std::move(cleaner.report);
}

}  // namespace weir
