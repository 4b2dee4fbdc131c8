// Contexts of the CUDA driver: what a process has of a device. The runtime makes one on the current device for any call
// of a thread that has none.
#pragma once

#include <cstdint>

namespace weir {

/// The calling thread's; null where it has none, or there is no driver.
void* current_context();

/// For the calling thread; null: it has none then.
void set_current_context(void* context);

/// Whether this process has the context on `device` that the runtime uses. Makes none.
bool has_context(int device);

/// That context, which is made where there is none, and stays until the process ends or the device is reset; null where
/// the driver cannot. Makes it current nowhere. Thread-safe.
void* primary_context(int device);

/// Which context of which device the calling thread works in: a device that is reset has another one afterwards. 0
/// where the thread has none, or the driver does not tell (before CUDA 12).
std::uint64_t current_context_id();

}  // namespace weir
