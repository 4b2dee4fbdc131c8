// Contexts of the CUDA driver: a process's state on a device. The runtime makes one on the current device at any call
// of a thread that has none.
#pragma once

#include <cstdint>

namespace weir {

/// Returns the calling thread's context; null if it has none, or there is no driver.
void* current_context();

/// Sets the calling thread's context; null: the thread has none afterwards.
void set_current_context(void* context);

/// Returns whether this process has the runtime's context on `device`. Makes none.
bool has_context(int device);

/// Returns the runtime's context on `device`. Makes it if there is none; it stays until the process ends or the
/// device is reset. Returns null if the driver cannot. Does not make the context current. Thread-safe.
void* primary_context(int device);

/// Returns an id of the context that the calling thread works in. After a reset, a device has a context with another
/// id. Returns 0 if the thread has no context, or if the driver has no ids (before CUDA 12).
std::uint64_t current_context_id();

}  // namespace weir
