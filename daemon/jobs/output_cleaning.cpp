#include "daemon/jobs/output_cleaning.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/types.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>

#include "compressor/resume/journal.h"
#include "daemon/store/file_identity.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "format/io/file_system.h"
#include "format/io/is_directory.h"
#include "format/io/output_names.h"
#include "format/io/real_path.h"
#include "format/output/commit_leftovers.h"

namespace weir {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// How long an interrupted conversion is kept that nobody continues. It may take as much disk space as its result.
constexpr std::chrono::hours kKeptFor{7 * 24};

constexpr std::string_view kPicturePartialEnding = ".png.partial";
static_assert(kPicturePartialEnding.ends_with(kPartialEnding));

// Returns the output (something.nvdb) of the conversion that left `path`; none if no conversion left it.
std::optional<fs::path> output_of(const fs::path& path) {
  const std::string name = path.filename().string();
  const auto without = [&](std::string_view ending, std::size_t from) -> std::optional<fs::path> {
    if (!name.ends_with(ending) || name.size() < from + ending.size()) return std::nullopt;
    const std::string output = name.substr(from, name.size() - from - ending.size());
    if (!output.ends_with(".nvdb")) return std::nullopt;
    return path.parent_path() / output;
  };
  if (name.starts_with('.')) {
    if (auto output = without(kWorkEnding, 1)) return output;
  }
  for (const std::string_view ending :
       {kSidecarPartialEnding, kSidecarPreviousEnding, kPicturePartialEnding, kPartialEnding}) {
    if (auto output = without(ending, 0)) return output;
  }
  return std::nullopt;
}

bool is_work(const fs::path& path) { return path.filename().string().ends_with(kWorkEnding); }

bool is_picture(const fs::path& path) { return path.filename().string().ends_with(kPicturePartialEnding); }

// Returns whether a writer holds the file's lock. Opens the file for writing, because NFS gives an exclusive lock
// only then.
bool is_locked_by_writer(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  return file && ::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

// Removes spill files. They have no names if the file system supports that; otherwise a kill may come between the
// creation of a spill file and the removal of its name.
void remove_spills(const fs::path& work) {
  std::error_code error;
  for (fs::directory_iterator at(work, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if (name.starts_with("spill") && name.size() == 11) fs::remove(at->path(), ignored);
  }
}

// Throws Error(io) if the path cannot be looked at.
bool is_missing(const fs::path& path) {
  std::error_code error;
  const bool exists = fs::exists(path, error);
  if (error) throw io_error(path.string(), "look at it", error.value());
  return !exists;
}

std::string entry_of(const Checkpoint& checkpoint, const char* name) {
  const auto at = checkpoint.identity.find(name);
  return at == checkpoint.identity.end() ? std::string() : at->second;
}

// Returns whether the source, judged by its first file, is still the one of the checkpoint. Also true if it cannot be
// looked at, for example because a file server does not answer.
bool is_of_this_source(const Checkpoint& checkpoint) {
  const std::string path = entry_of(checkpoint, "source");
  const auto source = identify(path);
  if (!source) return !is_gone(path);
  // The recorded size and time are of all files together, so they cannot be compared with one file.
  if (!entry_of(checkpoint, "source files").empty()) return true;
  return cat(source->bytes) == entry_of(checkpoint, "source bytes") &&
         cat(source->mtime_ns) == entry_of(checkpoint, "source modified (ns)");
}

// Reads the journal without the locks that read_journal takes, because the conversion may be running.
std::optional<Checkpoint> glance_at_journal(const fs::path& work) {
  std::ifstream file(work / "journal", std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return parse_checkpoint(text.str());
}

class Cleaner {
 public:
  explicit Cleaner(std::chrono::milliseconds patience) : deadline_(Clock::now() + patience) {}

  using Worthless = std::function<bool(const fs::path& work, const fs::path& output)>;

  /// Removes `paths`, leftovers of `output`. Removes a work directory only if `worthless` returns true for it.
  void clean(const fs::path& output, const std::vector<fs::path>& paths, const Worthless& worthless) {
    const std::string lock_path = partial_path(output.string());
    try {
      const bool was_there = files->exists(lock_path);
      // The lock keeps a conversion from starting on the files that are checked and removed here.
      const std::unique_ptr<File> lock = hold(lock_path);
      if (lock == nullptr) {
        leave(lock_path, "another process is writing it");
        return;
      }
      for (const fs::path& path : paths) {
        if (is_work(path)) {
          clean_work(path, output, worthless);
        } else if (path.filename().string().ends_with(kSidecarPreviousEnding)) {
          restore(path);
        } else if (is_picture(path)) {
          remove_picture(path);
        } else if (path != lock_path) {
          remove(path);
        }
      }
      if (was_there) {
        remove_early_sidecar(output.string(), *lock);
        remove(lock_path);
      } else {
        files->remove(lock_path);
      }
    } catch (const Error& error) {
      leave(paths.front(), error.what());
    }
  }

  CleaningReport report;
  const std::unique_ptr<FileSystem> files = make_posix_file_system();

 private:
  // Takes the lock. Returns null if another process holds it at the deadline.
  std::unique_ptr<File> hold(const std::string& lock_path) const {
    bool was_free = false;
    for (;;) {
      try {
        return files->open(lock_path);
      } catch (const Error&) {
        // The writer may have ended since. If a free file cannot be opened twice in a row, the error is another one.
        const bool is_free = !is_locked_by_writer(lock_path);
        if (is_free && was_free) throw;
        was_free = is_free;
        if (is_free) continue;
        if (Clock::now() >= deadline_) return nullptr;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  void clean_work(const fs::path& work, const fs::path& output, const Worthless& worthless) {
    try {
      if (!worthless(work, output)) return;
      remove_leftovers(*files, output);
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

  // The process that renders a picture holds a lock on the picture itself, not on its volume.
  void remove_picture(const fs::path& path) {
    if (!is_locked_by_writer(path.string())) remove(path);
  }

  // Restores the sidecar of a volume that was to be replaced (see the numbered steps in
  // format/output/output_files.cpp) if its volume is still there. It also replaces the sidecar that the killed commit
  // put beside that volume. If one of them cannot be read, all stay as they are.
  void restore(const fs::path& path) {
    const fs::path record = fs::path(path).replace_extension();  // without .previous
    const std::string volume = fs::path(record).replace_extension().string();
    try {
      if (is_missing(record)) return files->rename(path.string(), record.string());
      if (is_missing(volume)) return remove(path);
      switch (find_own_sidecar(*files, path.string(), record.string(), volume)) {
        case OwnSidecar::previous:
          return files->rename(path.string(), record.string());
        case OwnSidecar::in_place:
          return remove(path);
        case OwnSidecar::neither:
          return leave(path,
                       cat("may be the sidecar of ", volume, ", which cannot be told; compare it by weir verify"));
      }
    } catch (const Error& error) {
      leave(path, error.what());
    }
  }

  // Removes a sidecar that a killed commit put beside a volume without one. Once OUT.nvdb.partial is gone, that
  // sidecar could be taken for the volume's own.
  void remove_early_sidecar(const std::string& output, File& partial) {
    const std::string sidecar = cat(output, kSidecarEnding);
    if (!files->exists(output) || !files->exists(sidecar) || files->exists(cat(output, kSidecarPreviousEnding))) return;
    if (came_too_early(*files, sidecar, output, partial)) remove(sidecar);
  }

  void leave(const fs::path& path, const std::string& reason) {
    report.left.push_back(cat(path.string(), ": ", reason));
  }

  Clock::time_point deadline_;
};

template <typename Iterator>
void list(const std::string& directory, std::map<fs::path, std::vector<fs::path>>& by_output) {
  std::error_code error;
  for (auto at = Iterator(directory, fs::directory_options::skip_permission_denied, error); !error && at != end(at);
       at.increment(error)) {
    const std::optional<fs::path> output = output_of(at->path());
    std::error_code ignored;
    if (output && (is_work(at->path()) ? at->is_directory(ignored) : at->is_regular_file(ignored))) {
      by_output[*output].push_back(at->path());
    }
  }
}

}  // namespace

CleaningReport clean_outputs(const std::string& directory, const std::string& sources, bool recursive,
                             std::chrono::milliseconds patience) {
  Cleaner cleaner(patience);
  const fs::path own = real_path(sources);
  const auto worthless = [&](const fs::path& work, const fs::path& output) {
    const std::optional<Checkpoint> interrupted = read_journal(*cleaner.files, output);
    if (!interrupted) return true;
    // The source of a stack is a pattern, and the service converts none.
    if (entry_of(*interrupted, "format") == "stack" || !lies_below(entry_of(*interrupted, "source"), own)) return false;
    std::error_code ignored;
    const bool old = fs::file_time_type::clock::now() - fs::last_write_time(work, ignored) > kKeptFor;
    // If the directory is missing, all files in it seem to be gone.
    return old || (is_directory(own.string()) && !is_of_this_source(*interrupted));
  };
  // Collects the paths first: a file that is removed while its directory is read may be listed or not.
  std::map<fs::path, std::vector<fs::path>> by_output;
  if (recursive) {
    list<fs::recursive_directory_iterator>(directory, by_output);
  } else {
    list<fs::directory_iterator>(directory, by_output);
  }
  for (auto& [output, paths] : by_output) {
    std::sort(paths.begin(), paths.end());
    cleaner.clean(output, paths, worthless);
  }
  return std::move(cleaner.report);
}

CleaningReport discard_interrupted(const std::string& directory, const std::string& source) {
  Cleaner cleaner(std::chrono::milliseconds(0));
  const std::string place = real_path(source).string();
  const auto of_source = [&](const fs::path& work) {
    const std::optional<Checkpoint> interrupted = glance_at_journal(work);
    return interrupted && entry_of(*interrupted, "source") == place;
  };
  std::map<fs::path, std::vector<fs::path>> by_output;
  list<fs::directory_iterator>(directory, by_output);
  for (auto& [output, paths] : by_output) {
    std::erase_if(paths, [&](const fs::path& path) { return !is_work(path) || !of_source(path); });
    if (paths.empty()) continue;
    cleaner.clean(output, paths, [&](const fs::path& work, const fs::path&) { return of_source(work); });
  }
  return std::move(cleaner.report);
}

}  // namespace weir
