// The part of NVIDIA's cuFile library that weir uses, declared as in its documentation ("cuFile API Reference
// Guide"). weir builds without the library and its header.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace weir::cufile {

struct Status {
  int code;       ///< CUfileOpError, 0: success
  int cuda_code;  ///< CUresult, if `code` says that the CUDA driver failed
};

inline constexpr int kDescriptorHandle = 1;  ///< CU_FILE_HANDLE_TYPE_OPAQUE_FD

struct FileDescription {
  int type;
  union {
    int descriptor;
    void* handle;
  } file;
  const void* operations;
};
static_assert(sizeof(FileDescription) == 24 && offsetof(FileDescription, file) == 8);

using Handle = void*;
using DriverOpen = Status (*)();
using DriverClose = Status (*)();
using HandleRegister = Status (*)(Handle*, FileDescription*);
using HandleDeregister = void (*)(Handle);
/// Returns the bytes read, -1 with errno set, or a smaller number: minus a CUfileOpError.
using Read = ssize_t (*)(Handle, void* device_base, std::size_t bytes, off_t file_offset, off_t device_offset);

/// Returns why a read at byte `at` of the file returned `got`, which is 0 or less. For -1 the reason comes from
/// errno.
std::string read_failure(ssize_t got, std::uint64_t at);

}  // namespace weir::cufile

namespace weir {

/// The library's functions. The destructor closes the library's driver if `opened` is set.
struct CuFile {
  CuFile() = default;
  ~CuFile() {
    if (opened) driver_close();
  }
  CuFile(const CuFile&) = delete;
  CuFile& operator=(const CuFile&) = delete;

  cufile::DriverOpen driver_open = nullptr;
  cufile::DriverClose driver_close = nullptr;
  cufile::HandleRegister handle_register = nullptr;
  cufile::HandleDeregister handle_deregister = nullptr;
  cufile::Read read = nullptr;
  bool opened = false;
};

}  // namespace weir
