// The calls of the CUDA runtime that the loader makes, pretended on the host, so that loading, its threads and its
// failures are tested where there is no device: device memory is host memory, a stream does at once what it is given.
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

/// What the pretended device does; reset() between tests. Any thread may call.
class FakeRuntime {
 public:
  static FakeRuntime& instance();
  /// There is one device then, without a context, and the next one is another.
  void reset();

  void set_devices(int count);
  int devices();
  /// That the calling thread works on: that of its context, else the one that it chose last, at first 0.
  int current_device();
  /// Chooses `device`, and makes its context current.
  void choose(int device);
  /// A context of `device` that its user made; the number of the one that the runtime uses is the device's.
  static constexpr int own_context(int device) { return kMostDevices + device; }
  /// Makes a context current; none: the calling thread has no context.
  void make_current(std::optional<int> context);
  std::optional<int> current_context();
  /// A stream of the current context, and what a call returns that gives work to `stream`, which is of one context.
  cudaStream_t make_stream();
  cudaError_t enter_stream(cudaStream_t stream);
  /// What copies and waits named: null, for one, or cudaStreamLegacy.
  std::set<cudaStream_t> streams_named();
  void name_stream(cudaStream_t stream);
  /// As a call on a thread that has no context does, for current_device().
  void make_some_current();
  /// Makes the context of `device`, or counts one more who holds it.
  void retain(int device);
  /// The context goes with the last one, but where the runtime has it.
  void release(int device);
  int references(int device);
  /// The number of the calling thread's context; 0: it has none.
  std::uint64_t context();
  std::uint64_t context_of(int context);
  /// Those that have a context.
  std::set<int> devices_in_use();

  /// The `nth` call (0: the next) of `function` fails with `code`; a sticky one makes all later calls fail too.
  void fail(const std::string& function, int nth, cudaError_t code, bool sticky = false);
  /// All later calls too, from that one on, until heal().
  void fail_from(const std::string& function, int nth, cudaError_t code);
  /// No call fails any more, but for what stuck.
  void heal();
  /// Memory of the device; reset() gives it 4 GiB.
  void set_capacity(std::uint64_t bytes);
  std::uint64_t capacity();
  void set_attribute(cudaDeviceAttr attribute, int value);
  int attribute(cudaDeviceAttr attribute);

  /// At the beginning of a call: what it returns.
  cudaError_t enter(const std::string& function);
  /// The same of one that allocates device memory, and as "allocation" with all that do: there may be no room.
  cudaError_t enter_allocation(const std::string& function, std::uint64_t bytes);
  /// Failures returned and not cleared by cudaGetLastError; a sticky one stays.
  cudaError_t take_last_error();

  // Ranges that are registered, and memory that is allocated; address and bytes.
  cudaError_t register_range(std::uintptr_t address, std::uint64_t bytes, unsigned flags);
  cudaError_t unregister_range(std::uintptr_t address);
  bool registered(std::uintptr_t address, std::uint64_t bytes);
  void allocated(std::uintptr_t address, std::uint64_t bytes);
  bool freed(std::uintptr_t address);
  bool holds(std::uintptr_t address);  ///< in memory that is allocated

  // Copies from memory that is registered, which end when something waits for them.
  void copy_begins(std::uintptr_t from);
  void event_recorded(std::uintptr_t event);  ///< after all copies so far
  void event_awaited(std::uintptr_t event);
  void stream_awaited();
  std::uint64_t unlocked_while_copied();  ///< ranges that were unregistered before

  bool broken();  ///< by a failure that sticks
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
    bool later = false;  ///< calls, too
  };

  static constexpr int kMostDevices = 8;
  static constexpr std::uintptr_t kFirstStream = 256;  // lower ones are the runtime's own

  // What a thread works on.
  struct Thread {
    std::uint64_t generation = 0;  // a reset makes it forget the rest
    int chosen = 0;
    std::optional<int> context = {};
  };
  Thread& thread();  // the calling one's
  std::uint64_t number_of(int context) const { return 16 * generation_ + static_cast<std::uint64_t>(context); }

  std::mutex mutex_;
  int devices_ = 1;
  std::set<int> in_use_;           // by the runtime
  std::map<int, int> references_;  // by device, of others
  std::vector<Fault> faults_;
  std::map<std::string, std::uint64_t> calls_;
  std::map<cudaDeviceAttr, int> attributes_;
  std::map<std::uintptr_t, std::uint64_t> registered_;
  std::map<std::uintptr_t, std::uint64_t> allocated_;
  std::uint64_t most_registered_ = 0;
  std::uint64_t copies_ = 0;                              // that began; their numbers are 1, 2, ...
  std::uint64_t copies_ended_ = 0;                        // up to that number
  std::map<std::uintptr_t, std::uint64_t> last_copies_;   // by range, the number of its last one
  std::map<std::uintptr_t, std::uint64_t> event_copies_;  // by event, that of the last one before it
  std::uint64_t unlocked_while_copied_ = 0;
  std::uint64_t capacity_ = 0;
  std::uint64_t generation_ = 0;
  cudaError_t sticky_ = cudaSuccess;
  cudaError_t last_ = cudaSuccess;
  std::set<cudaStream_t> streams_named_;
};

}  // namespace weir::test
