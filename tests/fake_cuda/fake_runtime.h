// Pretends the loader's calls of the CUDA runtime on the host, so that loading, its threads and its failures can be
// tested without a device. Device memory is host memory, and a stream does its work at once.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace weir::test {

/// The state and faults of the pretended device. Call reset() between tests. Any thread may call.
class FakeRuntime {
 public:
  static FakeRuntime& instance();
  /// Resets to one device without a context. Its next context is a new one.
  void reset();

  void set_devices(int count);
  int devices();
  /// Returns the device that the calling thread works on: its context's device, otherwise the one it chose last, 0 at
  /// first.
  int current_device();
  /// Chooses `device`, and makes its context current.
  void choose(int device);
  /// Returns the number of a context of `device` that a user made. The runtime's own context has the device's number.
  static constexpr int own_context(int device) { return kMostDevices + device; }
  /// Makes a context current; nullopt: the calling thread has no context.
  void make_current(std::optional<int> context);
  std::optional<int> current_context();
  /// make_stream() makes a stream of the current context. enter_stream() returns the result of a call that gives work
  /// to `stream`, which belongs to one context.
  cudaStream_t make_stream();
  cudaError_t enter_stream(cudaStream_t stream);
  /// Returns the streams that copies and waits have named, null and cudaStreamLegacy among them.
  std::set<cudaStream_t> streams_named();
  void name_stream(cudaStream_t stream);
  /// Makes a context of current_device() if the thread has none, as any call of the runtime does.
  void make_some_current();
  /// Makes the context of `device`, or counts one more holder.
  void retain(int device);
  /// Counts one holder less. The context ends with the last holder, unless the runtime uses it.
  void release(int device);
  int references(int device);
  /// Returns the number of the calling thread's context; 0 if it has none.
  std::uint64_t context();
  std::uint64_t context_of(int context);
  /// Returns the devices that have a context.
  std::set<int> devices_in_use();

  /// Makes the `nth` call (0: the next) of `function` fail with `code`. A sticky failure makes all later calls fail,
  /// too.
  void fail(const std::string& function, int nth, cudaError_t code, bool sticky = false);
  /// Makes that call and all later ones fail, until heal().
  void fail_from(const std::string& function, int nth, cudaError_t code);
  /// Lets all calls succeed again, except after a sticky failure.
  void heal();
  /// Sets the memory of the device; reset() sets 4 GiB.
  void set_capacity(std::uint64_t bytes);
  std::uint64_t capacity();
  void set_attribute(cudaDeviceAttr attribute, int value);
  int attribute(cudaDeviceAttr attribute);

  /// Called at the beginning of a call; returns the call's result.
  cudaError_t enter(const std::string& function);
  /// The same for a call that allocates device memory. Also counts as "allocation", the name of all such calls. There
  /// may be no room.
  cudaError_t enter_allocation(const std::string& function, std::uint64_t bytes);
  /// Returns the last failure that cudaGetLastError has not cleared; a sticky one stays.
  cudaError_t take_last_error();

  // Registered ranges and allocated memory, by address and bytes.
  cudaError_t register_range(std::uintptr_t address, std::uint64_t bytes, unsigned flags);
  cudaError_t unregister_range(std::uintptr_t address);
  bool registered(std::uintptr_t address, std::uint64_t bytes);
  void allocated(std::uintptr_t address, std::uint64_t bytes);
  bool freed(std::uintptr_t address);
  bool holds(std::uintptr_t address);  ///< whether the address is in allocated memory

  // Copies from registered memory. A copy ends when something waits for it.
  void copy_begins(std::uintptr_t from);
  void event_recorded(std::uintptr_t event);  ///< the event follows all copies so far
  void event_awaited(std::uintptr_t event);
  void stream_awaited();
  std::uint64_t unlocked_while_copied();  ///< number of ranges that were unregistered before their copies ended

  bool broken();  ///< whether a sticky failure has happened
  std::uint64_t registered_bytes();
  std::uint64_t most_registered_bytes();
  std::uint64_t allocated_bytes();
  std::uint64_t calls(const std::string& function);

 private:
  struct Fault {
    std::string function;
    std::uint64_t call;
    cudaError_t code;
    bool sticky;
    bool later = false;  ///< later calls fail, too
  };

  static constexpr int kMostDevices = 8;
  static constexpr std::uintptr_t kFirstStream = 256;  // lower numbers are the runtime's own streams

  // The device and context of a thread.
  struct Thread {
    std::uint64_t generation = 0;  // after a reset the rest is forgotten
    int chosen = 0;
    std::optional<int> context = {};
  };
  Thread& thread();  // the calling thread's
  std::uint64_t number_of(int context) const { return 16 * generation_ + static_cast<std::uint64_t>(context); }

  std::mutex mutex_;
  int devices_ = 1;
  std::set<int> in_use_;           // devices with a context that the runtime uses
  std::map<int, int> references_;  // by device: number of other holders
  std::vector<Fault> faults_;
  std::map<std::string, std::uint64_t> calls_;
  std::map<cudaDeviceAttr, int> attributes_;
  std::map<std::uintptr_t, std::uint64_t> registered_;
  std::map<std::uintptr_t, std::uint64_t> allocated_;
  std::uint64_t most_registered_ = 0;
  std::uint64_t copies_ = 0;                              // copies that began, numbered 1, 2, ...
  std::uint64_t copies_ended_ = 0;                        // copies up to this number have ended
  std::map<std::uintptr_t, std::uint64_t> last_copies_;   // by range: number of its last copy
  std::map<std::uintptr_t, std::uint64_t> event_copies_;  // by event: number of the last copy before it
  std::uint64_t unlocked_while_copied_ = 0;
  std::uint64_t capacity_ = 0;
  std::uint64_t generation_ = 0;
  cudaError_t sticky_ = cudaSuccess;
  cudaError_t last_ = cudaSuccess;
  std::set<cudaStream_t> streams_named_;
};

}  // namespace weir::test
