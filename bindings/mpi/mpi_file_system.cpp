#include "bindings/mpi/mpi_file_system.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::size_t kMostFileBytes = std::size_t{1} << 30U;  // per call, because counts are int

class MpiFile final : public File {
 public:
  // `own` is the leading rank's file, which that rank made or opened; `mode` is MPI_MODE_RDWR or MPI_MODE_RDONLY.
  MpiFile(MpiTeam& team, std::string path, std::unique_ptr<File> own, int mode)
      : team_(team), path_(std::move(path)), own_(std::move(own)) {
    const std::lock_guard lock(team_.calls());
    const int code = MPI_File_open(MPI_COMM_SELF, path_.c_str(), mode, MPI_INFO_NULL, &file_);
    int kind = MPI_SUCCESS;
    MPI_Error_class(code, &kind);
    if (kind == MPI_ERR_NO_SUCH_FILE && !team_.leads()) {
      throw Error(ErrorKind::io, cat(path_, ": process ", team_.rank(), " of ", team_.size(),
                                     " does not find what process 0 made; output and work directory must be on a file "
                                     "system that all processes share"));
    }
    check_mpi(code, "opening " + path_);
  }
  ~MpiFile() override {
    const std::lock_guard lock(team_.calls());
    MPI_File_close(&file_);
  }
  MpiFile(const MpiFile&) = delete;
  MpiFile& operator=(const MpiFile&) = delete;

  const std::string& path() const override { return path_; }

  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    transfer(bytes, "writing ", "written", [&](std::size_t at, int count, MPI_Status* status) {
      return MPI_File_write_at(file_, static_cast<MPI_Offset>(offset + at), bytes.data() + at, count, MPI_BYTE, status);
    });
  }
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override {
    transfer(bytes, "reading ", "there to be read", [&](std::size_t at, int count, MPI_Status* status) {
      return MPI_File_read_at(file_, static_cast<MPI_Offset>(offset + at), bytes.data() + at, count, MPI_BYTE, status);
    });
  }

  bool preallocate(std::uint64_t bytes) override {
    bool reserved = false;
    team_.lead([&] { reserved = own_->preallocate(bytes); });
    team_.follow(reserved);
    return reserved;
  }
  void clear() override {
    team_.lead([&] { own_->clear(); });
  }
  void start_writeback() override {
    if (own_) own_->start_writeback();
  }
  void sync() override {
    const std::lock_guard lock(team_.calls());
    check_mpi(MPI_File_sync(file_), "flushing " + path_);
  }
  bool exclusive() const override {
    bool alone = true;
    team_.lead([&] { alone = own_->exclusive(); });
    team_.follow(alone);
    return alone;
  }
  bool has_its_name() const override {
    bool named = true;
    team_.lead([&] { named = own_->has_its_name(); });
    team_.follow(named);
    return named;
  }
  std::uint64_t size() override {
    MPI_Offset bytes = 0;
    const std::lock_guard lock(team_.calls());
    check_mpi(MPI_File_get_size(file_, &bytes), "asking for the size of " + path_);
    return static_cast<std::uint64_t>(bytes);
  }

 private:
  // Transfers all of `bytes`, in as many calls as needed.
  template <typename Call>
  void transfer(std::span<const std::byte> bytes, const char* action, const char* done, const Call& call) const {
    for (std::size_t at = 0; at < bytes.size();) {
      MPI_Status status{};
      int count = 0;
      const std::lock_guard lock(team_.calls());
      check_mpi(call(at, static_cast<int>(std::min(kMostFileBytes, bytes.size() - at)), &status), action + path_);
      MPI_Get_count(&status, MPI_BYTE, &count);
      if (count <= 0) throw Error(ErrorKind::io, cat(path_, ": nothing more is ", done));
      at += static_cast<std::size_t>(count);
    }
  }

  MpiTeam& team_;
  std::string path_;
  std::unique_ptr<File> own_;
  MPI_File file_ = MPI_FILE_NULL;
};

class MpiFileSystem final : public FileSystem {
 public:
  MpiFileSystem(MpiTeam& team, FileSystem& files) : team_(team), files_(files) {}

  std::unique_ptr<File> create(const std::string& path) override {
    std::unique_ptr<File> own;
    team_.lead([&] { own = files_.create(path); });
    try {
      return shared(path, std::move(own));
    } catch (const Error&) {  // some process does not find the file: nothing of it may stay
      team_.lead([&] { files_.remove(path); });
      throw;
    }
  }
  std::unique_ptr<File> open(const std::string& path) override {
    std::unique_ptr<File> own;
    team_.lead([&] { own = files_.open(path); });
    return shared(path, std::move(own));
  }
  std::unique_ptr<File> open_to_read(const std::string& path) override {
    // All ranks call exists(), so that all of them learn of a missing file.
    if (!exists(path)) throw io_error(path, "open for reading", ENOENT);
    std::unique_ptr<File> own;
    team_.lead([&] { own = files_.open_to_read(path); });
    return shared(path, std::move(own), MPI_MODE_RDONLY);
  }
  // The file has a name until all ranks have opened it, because other ranks cannot open a file without a name.
  std::unique_ptr<File> create_unnamed(const std::string& directory) override {
    const std::string name = cat("/.weir.", ::getpid(), '.', unnamed_++);
    std::vector<char> leading(name.begin(), name.end());
    team_.follow(leading);
    const std::string path = directory + std::string(leading.begin(), leading.end());
    std::unique_ptr<File> file = create(path);
    remove(path);
    return file;
  }
  void rename(const std::string& from, const std::string& to) override {
    team_.lead([&] { files_.rename(from, to); });
  }
  void rename_new(const std::string& from, const std::string& to) override {
    team_.lead([&] { files_.rename_new(from, to); });
  }
  bool link(const std::string& from, const std::string& to) override {
    return ask<bool>([&] { return files_.link(from, to); });
  }
  void remove(const std::string& path) override {
    team_.lead([&] { files_.remove(path); });
  }
  void make_directory(const std::string& path) override {
    team_.lead([&] { files_.make_directory(path); });
  }
  void remove_directory(const std::string& path) override {
    team_.lead([&] { files_.remove_directory(path); });
  }
  void sync_directory(const std::string& path) override {
    team_.lead([&] { files_.sync_directory(path); });
  }
  bool exists(const std::string& path) override {
    return ask<bool>([&] { return files_.exists(path); });
  }
  bool is_replaceable(const std::string& path) override {
    return ask<bool>([&] { return files_.is_replaceable(path); });
  }
  bool is_memory(const std::string& directory) override {
    return ask<bool>([&] { return files_.is_memory(directory); });
  }
  std::uint64_t free_bytes(const std::string& directory) override {
    return ask<std::uint64_t>([&] { return files_.free_bytes(directory); });
  }

 private:
  template <typename Answer>
  Answer ask(const std::function<Answer()>& question) {
    Answer answer{};
    team_.lead([&] { answer = question(); });
    team_.follow(answer);
    return answer;
  }

  // `own` is the leading rank's file.
  std::unique_ptr<File> shared(const std::string& path, std::unique_ptr<File> own, int mode = MPI_MODE_RDWR) {
    std::unique_ptr<File> file;
    team_.run([&] { file = std::make_unique<MpiFile>(team_, path, std::move(own), mode); });
    return file;
  }

  MpiTeam& team_;
  FileSystem& files_;
  int unnamed_ = 0;
};

}  // namespace

std::unique_ptr<FileSystem> make_mpi_file_system(MpiTeam& team, FileSystem& files) {
  return std::make_unique<MpiFileSystem>(team, files);
}

}  // namespace weir
