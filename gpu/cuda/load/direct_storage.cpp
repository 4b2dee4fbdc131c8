#include "gpu/cuda/load/direct_storage.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <type_traits>

#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "gpu/cuda/load/cufile.h"
#include "gpu/cuda/load/parallel_read.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {
namespace {

// Thrown to end the reads of all threads.
class ReadRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string status_text(const cufile::Status& status) {
  return status.cuda_code == 0 ? cat("cuFile error ", status.code)
                               : cat("cuFile error ", status.code, ", CUDA driver error ", status.cuda_code);
}

// Opens the file again for reads past the page cache. It is the same file even if its path names another one now.
Descriptor open_direct(const FileMapping& file) {
  const std::string path = cat("/proc/self/fd/", file.descriptor());
  return Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_DIRECT));
}

class FileHandle {
 public:
  FileHandle(const CuFile& library, int descriptor) : library_(library) {
    cufile::FileDescription description{};
    description.type = cufile::kDescriptorHandle;
    description.file.descriptor = descriptor;
    status_ = library_.handle_register(&handle_, &description);
  }
  ~FileHandle() {
    if (status_.code == 0) library_.handle_deregister(handle_);
  }
  FileHandle(const FileHandle&) = delete;
  FileHandle& operator=(const FileHandle&) = delete;

  const cufile::Status& status() const { return status_; }
  cufile::Handle get() const { return handle_; }

 private:
  const CuFile& library_;
  cufile::Handle handle_ = nullptr;
  cufile::Status status_{};
};

}  // namespace

std::string cufile::read_failure(ssize_t got, std::uint64_t at) {
  if (got == -1) return std::strerror(errno);
  if (got == 0) return cat("the file ends at byte ", at);
  return status_text({static_cast<int>(-got), 0});
}

bool DirectStorage::offered() { return ::access("/proc/driver/nvidia-fs/version", F_OK) == 0; }

std::optional<DirectStorage> DirectStorage::open(std::string& refusal) {
  // The library is never unloaded, because it has its own threads.
  void* const library = ::dlopen("libcufile.so.0", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr) {
    const char* const reason = ::dlerror();
    refusal = cat("GPUDirect Storage: ", reason == nullptr ? "libcufile.so.0 does not load" : reason);
    return std::nullopt;
  }
  const auto functions = std::make_shared<CuFile>();
  std::string missing;
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(library, name));
    if (function == nullptr) missing = name;
  };
  find(functions->driver_open, "cuFileDriverOpen");
  find(functions->driver_close, "cuFileDriverClose");
  find(functions->handle_register, "cuFileHandleRegister");
  find(functions->handle_deregister, "cuFileHandleDeregister");
  find(functions->read, "cuFileRead");
  ::dlclose(library);
  if (!missing.empty()) {
    refusal = cat("GPUDirect Storage: libcufile.so.0 has no ", missing);
    return std::nullopt;
  }
  if (const cufile::Status status = functions->driver_open(); status.code != 0) {
    refusal = cat("GPUDirect Storage: its driver does not open: ", status_text(status));
    return std::nullopt;
  }
  functions->opened = true;
  return DirectStorage(functions);
}

CopyOutcome DirectStorage::copy(const CopyTask& task) const {
  const Descriptor direct = open_direct(task.file);
  if (!direct) return {cat("GPUDirect Storage: no direct reads of ", task.file.path(), ": ", std::strerror(errno)), {}};
  const FileHandle handle(*library_, direct.get());
  if (handle.status().code != 0) {
    return {cat("GPUDirect Storage: ", task.file.path(), ": ", status_text(handle.status())), {}};
  }
  CopyOutcome outcome;
  std::mutex mutex;
  const auto take = [&](int, const FilePiece& piece) {
    double seconds = 0;
    {
      const StageClock clock(seconds);
      for (std::uint64_t done = 0; done < piece.bytes;) {
        const ssize_t got = library_->read(handle.get(), task.target, piece.bytes - done,
                                           static_cast<off_t>(task.offset + piece.offset + done),
                                           static_cast<off_t>(piece.offset + done));
        if (got <= 0) {
          const std::string why = cufile::read_failure(got, task.offset + piece.offset + done);
          task.file.check_unchanged();
          throw ReadRefused(cat("GPUDirect Storage: reading ", task.file.path(), ": ", why));
        }
        done += static_cast<std::uint64_t>(got);
      }
    }
    const std::lock_guard lock(mutex);
    outcome.stages.populate_s += seconds;
  };
  try {
    for_each_piece(task, task.chunk_bytes, task.threads, take);
  } catch (const ReadRefused& refused) {
    outcome.refusal = refused.what();
  }
  return outcome;
}

}  // namespace weir
