// Owns device memory of a fixed number of elements.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "format/base/text.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {

/// `size` uninitialised elements of T, on the device that is current at construction. The memory comes from the
/// device's pool; unlike cudaFree, freeing it does not wait for other streams. T is trivially copyable. Transfers run
/// after what this thread started on its default stream, and are complete when they return.
template <class T>
class DeviceArray {
 public:
  DeviceArray() = default;
  /// Throws DeviceFull if the device has no room.
  explicit DeviceArray(std::size_t size) : DeviceArray() {  // delegates, so that the destructor runs if the rest throws
    size_ = size;
    if (size > 0) {
      check_cuda(cudaMallocAsync(reinterpret_cast<void**>(&data_), bytes(), cudaStreamPerThread),
                 cat("allocating ", format_bytes(bytes()), " of device memory"), bytes());
      check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "allocating device memory");
    }
  }
  explicit DeviceArray(std::span<const T> host) : DeviceArray(host.size()) { upload(host); }
  ~DeviceArray() {
    if (data_ != nullptr) cudaFreeAsync(data_, cudaStreamPerThread);
  }
  DeviceArray(DeviceArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

  /// Copies host.size() elements to the front of the array.
  void upload(std::span<const T> host) {
    if (!host.empty()) {
      transfer(data_, host.data(), host.size_bytes(), cudaMemcpyHostToDevice, "copying to the device");
    }
  }
  /// Copies the first host.size() elements to `host`.
  void download(std::span<T> host) const {
    if (!host.empty()) {
      transfer(host.data(), data_, host.size_bytes(), cudaMemcpyDeviceToHost, "copying from the device");
    }
  }
  std::vector<T> download() const {
    std::vector<T> host(size_);
    download(host);
    return host;
  }

 private:
  static void transfer(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, const char* what) {
    check_cuda(cudaMemcpyAsync(to, from, bytes, kind, cudaStreamPerThread), what);
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), what);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace weir
