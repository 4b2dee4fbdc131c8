// Owns the objects that libhdf5 hands out: files, groups, datasets, types, spaces, property lists.
#pragma once

#include <hdf5.h>

#include <utility>

#include "ingest/hdf5/file/hdf5_lock.h"

namespace weir {

/// Owns one reference to a libhdf5 object. The destructor takes the lock and releases the reference, on any thread.
class Hdf5Handle {
 public:
  Hdf5Handle() = default;
  /// Takes ownership of `id`. An invalid id (< 0), which failing calls return, is kept as it is.
  explicit Hdf5Handle(hid_t id) : id_(id) {}
  ~Hdf5Handle() { reset(); }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, H5I_INVALID_HID);
    }
    return *this;
  }

  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  void reset() noexcept {
    if (id_ < 0) return;
    const Hdf5Lock lock;
    H5Idec_ref(id_);
    id_ = H5I_INVALID_HID;
  }

  hid_t id_ = H5I_INVALID_HID;
};

}  // namespace weir
