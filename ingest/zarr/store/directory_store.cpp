#include "ingest/zarr/store/directory_store.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/input_file.h"

namespace weir {
namespace {

class FileObject final : public ZarrObject {
 public:
  explicit FileObject(const std::string& path) : file_(path, DirectIo::off) {}

  std::uint64_t size() const override { return file_.size(); }

  void read(std::uint64_t offset, std::span<std::byte> into) override {
    if (into.empty()) return;
    file_.read_buffered(offset, into, file_.path_for(offset, into.size()));
  }

 private:
  InputFile file_;
};

class DirectoryStore final : public ZarrStore {
 public:
  explicit DirectoryStore(std::string directory) : directory_(std::move(directory)) {}

  std::string shown(std::string_view key) const override { return joined_key(directory_, key); }
  std::string file_of(const std::string& key) const override { return shown(key); }
  bool is_one_file() const override { return false; }

  // In an array with many chunks that are not stored, most calls find nothing. Such a call makes only one system
  // call.
  ZarrFound find(const std::string& key) override {
    const std::string path = shown(key);
    struct stat status {};
    if (leads_out(key)) return {};
    if (::lstat(path.c_str(), &status) != 0) {
      if (errno == ENOENT) return {};
      if (errno == ENOTDIR) return {{}, "lies below a file that should be a directory; copy the array again"};
      throw io_error(path, "look at it", errno);
    }
    if (S_ISLNK(status.st_mode) && ::stat(path.c_str(), &status) != 0) {
      if (errno != ENOENT && errno != ENOTDIR) throw io_error(path, "look at it", errno);
      return {{}, "is a link to a file that is not there; fetch that file, or remove the link"};
    }
    if (S_ISDIR(status.st_mode)) {
      return {{}, "is a directory and not a file; copy the array again, or remove the directory"};
    }
    const FileState state = state_of(path, status);
    return {ZarrObjectState{state.bytes, state.mtime_ns, state.ctime_ns}, {}};
  }

  std::unique_ptr<ZarrObject> open(const std::string& key) override {
    if (!look(key)) return nullptr;
    return std::make_unique<FileObject>(shown(key));
  }

  std::vector<std::string> groups_in(const std::string& key) override {
    std::vector<std::string> names;
    std::error_code error;
    const std::string path = shown(key);
    for (std::filesystem::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_directory(ignored)) names.push_back(entry->path().filename().string());
    }
    if (error) throw io_error(path, "list the directory", error.value());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  static bool leads_out(const std::string& key) {
    const std::vector<std::string> parts = split(key, '/');
    return std::any_of(parts.begin(), parts.end(), [](const std::string& p) { return p == ".." || p == "."; });
  }

  std::string directory_;
};

}  // namespace

std::unique_ptr<ZarrStore> make_directory_store(const std::string& directory) {
  return std::make_unique<DirectoryStore>(directory);
}

}  // namespace weir
