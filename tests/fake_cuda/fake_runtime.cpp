#include "tests/fake_cuda/fake_runtime.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <numeric>
#include <utility>

namespace weir::test {
namespace {

std::uint64_t sum(const std::map<std::uintptr_t, std::uint64_t>& ranges) {
  return std::accumulate(ranges.begin(), ranges.end(), std::uint64_t{0},
                         [](std::uint64_t s, const auto& range) { return s + range.second; });
}

}  // namespace

FakeRuntime& FakeRuntime::instance() {
  static FakeRuntime* const runtime = [] {
    static FakeRuntime made;
    made.reset();
    return &made;
  }();
  return *runtime;
}

void FakeRuntime::reset() {
  const std::lock_guard lock(mutex_);
  registered_.clear();
  // Frees memory that a device did not take back because it failed for good.
  for (const auto& [address, bytes] : allocated_) std::free(reinterpret_cast<void*>(address));
  allocated_.clear();
  copies_ = copies_ended_ = unlocked_while_copied_ = 0;
  last_copies_.clear();
  event_copies_.clear();
  faults_.clear();
  calls_.clear();
  attributes_ = {{cudaDevAttrHostRegisterReadOnlySupported, 1}};
  most_registered_ = 0;
  capacity_ = std::uint64_t{1} << 32U;
  sticky_ = last_ = cudaSuccess;
  devices_ = 1;
  in_use_.clear();
  references_.clear();
  streams_named_.clear();
  ++generation_;
}

FakeRuntime::Thread& FakeRuntime::thread() {
  thread_local Thread here;
  if (here.generation != generation_) here = {generation_};
  return here;
}

void FakeRuntime::set_devices(int count) {
  const std::lock_guard lock(mutex_);
  devices_ = count;
}

int FakeRuntime::devices() {
  const std::lock_guard lock(mutex_);
  return devices_;
}

int FakeRuntime::current_device() {
  const std::lock_guard lock(mutex_);
  return thread().context ? *thread().context % kMostDevices : thread().chosen;
}

void FakeRuntime::choose(int device) {
  const std::lock_guard lock(mutex_);
  thread().chosen = device;
  thread().context = device;
  in_use_.insert(device);
}

void FakeRuntime::make_current(std::optional<int> context) {
  const std::lock_guard lock(mutex_);
  thread().context = context;
}

std::optional<int> FakeRuntime::current_context() {
  const std::lock_guard lock(mutex_);
  return thread().context;
}

cudaStream_t FakeRuntime::make_stream() {
  make_some_current();
  return reinterpret_cast<cudaStream_t>(kFirstStream + static_cast<std::uintptr_t>(*current_context()));
}

std::set<cudaStream_t> FakeRuntime::streams_named() {
  const std::lock_guard lock(mutex_);
  return streams_named_;
}

void FakeRuntime::name_stream(cudaStream_t stream) {
  const std::lock_guard lock(mutex_);
  streams_named_.insert(stream);
}

cudaError_t FakeRuntime::enter_stream(cudaStream_t stream) {
  name_stream(stream);
  const auto number = reinterpret_cast<std::uintptr_t>(stream);
  if (number < kFirstStream || static_cast<int>(number - kFirstStream) == current_context()) return cudaSuccess;
  const std::lock_guard lock(mutex_);
  return last_ = cudaErrorInvalidResourceHandle;
}

void FakeRuntime::make_some_current() {
  const std::lock_guard lock(mutex_);
  if (thread().context) return;
  thread().context = thread().chosen;
  in_use_.insert(thread().chosen);
}

void FakeRuntime::retain(int device) {
  const std::lock_guard lock(mutex_);
  ++references_[device];
}

void FakeRuntime::release(int device) {
  const std::lock_guard lock(mutex_);
  --references_[device];
}

int FakeRuntime::references(int device) {
  const std::lock_guard lock(mutex_);
  return references_[device];
}

std::uint64_t FakeRuntime::context() {
  const std::lock_guard lock(mutex_);
  const std::optional<int> context = thread().context;
  return context ? number_of(*context) : 0;
}

std::uint64_t FakeRuntime::context_of(int context) {
  const std::lock_guard lock(mutex_);
  return number_of(context);
}

std::set<int> FakeRuntime::devices_in_use() {
  const std::lock_guard lock(mutex_);
  std::set<int> devices = in_use_;
  for (const auto& [device, references] : references_) {
    if (references > 0) devices.insert(device);
  }
  return devices;
}

void FakeRuntime::fail(const std::string& function, int nth, cudaError_t code, bool sticky) {
  const std::lock_guard lock(mutex_);
  faults_.push_back({function, calls_[function] + static_cast<std::uint64_t>(nth), code, sticky});
}

void FakeRuntime::fail_from(const std::string& function, int nth, cudaError_t code) {
  const std::lock_guard lock(mutex_);
  faults_.push_back({function, calls_[function] + static_cast<std::uint64_t>(nth), code, false, true});
}

void FakeRuntime::heal() {
  const std::lock_guard lock(mutex_);
  faults_.clear();
}

void FakeRuntime::set_capacity(std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  capacity_ = bytes;
}

std::uint64_t FakeRuntime::capacity() {
  const std::lock_guard lock(mutex_);
  return capacity_;
}

void FakeRuntime::set_attribute(cudaDeviceAttr attribute, int value) {
  const std::lock_guard lock(mutex_);
  attributes_[attribute] = value;
}

int FakeRuntime::attribute(cudaDeviceAttr attribute) {
  const std::lock_guard lock(mutex_);
  return attributes_[attribute];
}

cudaError_t FakeRuntime::enter(const std::string& function) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t call = calls_[function]++;
  if (sticky_ != cudaSuccess) return sticky_;
  for (const Fault& fault : faults_) {
    if (fault.function != function || (fault.later ? call < fault.call : call != fault.call)) continue;
    if (fault.sticky) sticky_ = fault.code;
    return last_ = fault.code;
  }
  return cudaSuccess;
}

cudaError_t FakeRuntime::enter_allocation(const std::string& function, std::uint64_t bytes) {
  if (const cudaError_t code = enter(function); code != cudaSuccess) return code;
  if (const cudaError_t code = enter("allocation"); code != cudaSuccess) return code;
  const std::lock_guard lock(mutex_);
  return sum(allocated_) + bytes <= capacity_ ? cudaSuccess : last_ = cudaErrorMemoryAllocation;
}

cudaError_t FakeRuntime::take_last_error() {
  const std::lock_guard lock(mutex_);
  return std::exchange(last_, sticky_);
}

cudaError_t FakeRuntime::register_range(std::uintptr_t address, std::uint64_t bytes, unsigned flags) {
  const std::lock_guard lock(mutex_);
  // The driver does the same: the memory is mapped read-only, so nobody can write to it.
  if ((flags & cudaHostRegisterReadOnly) == 0) return last_ = cudaErrorInvalidValue;
  const auto next = registered_.upper_bound(address);
  const bool overlaps_next = next != registered_.end() && next->first < address + bytes;
  const bool overlaps_last = next != registered_.begin() && std::prev(next)->first + std::prev(next)->second > address;
  if (overlaps_next || overlaps_last) return last_ = cudaErrorHostMemoryAlreadyRegistered;
  constexpr int kPopulateRead = 22;  // fails for pages beyond the file's end, as page-locking does
  if (::madvise(reinterpret_cast<void*>(address), bytes, kPopulateRead) != 0) return last_ = cudaErrorInvalidValue;
  registered_[address] = bytes;
  most_registered_ = std::max(most_registered_, sum(registered_));
  return cudaSuccess;
}

cudaError_t FakeRuntime::unregister_range(std::uintptr_t address) {
  const std::lock_guard lock(mutex_);
  if (const auto last = last_copies_.extract(address); !last.empty() && last.mapped() > copies_ended_) {
    ++unlocked_while_copied_;
  }
  return registered_.erase(address) == 1 ? cudaSuccess : last_ = cudaErrorHostMemoryNotRegistered;
}

bool FakeRuntime::registered(std::uintptr_t address, std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto next = registered_.upper_bound(address);
  return next != registered_.begin() && std::prev(next)->first + std::prev(next)->second >= address + bytes;
}

void FakeRuntime::allocated(std::uintptr_t address, std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  allocated_[address] = bytes;
}

bool FakeRuntime::freed(std::uintptr_t address) {
  const std::lock_guard lock(mutex_);
  return allocated_.erase(address) == 1;
}

bool FakeRuntime::holds(std::uintptr_t address) {
  const std::lock_guard lock(mutex_);
  const auto next = allocated_.upper_bound(address);
  return next != allocated_.begin() && address - std::prev(next)->first < std::prev(next)->second;
}

void FakeRuntime::copy_begins(std::uintptr_t from) {
  const std::lock_guard lock(mutex_);
  ++copies_;
  const auto next = registered_.upper_bound(from);
  if (next == registered_.begin()) return;
  const auto& [address, bytes] = *std::prev(next);
  if (from - address < bytes) last_copies_[address] = copies_;
}

void FakeRuntime::event_recorded(std::uintptr_t event) {
  const std::lock_guard lock(mutex_);
  event_copies_[event] = copies_;
}

void FakeRuntime::event_awaited(std::uintptr_t event) {
  const std::lock_guard lock(mutex_);
  if (const auto copies = event_copies_.extract(event); !copies.empty()) {
    copies_ended_ = std::max(copies_ended_, copies.mapped());
  }
}

void FakeRuntime::stream_awaited() {
  const std::lock_guard lock(mutex_);
  copies_ended_ = copies_;
}

std::uint64_t FakeRuntime::unlocked_while_copied() {
  const std::lock_guard lock(mutex_);
  return unlocked_while_copied_;
}

bool FakeRuntime::broken() {
  const std::lock_guard lock(mutex_);
  return sticky_ != cudaSuccess;
}

std::uint64_t FakeRuntime::registered_bytes() {
  const std::lock_guard lock(mutex_);
  return sum(registered_);
}

std::uint64_t FakeRuntime::most_registered_bytes() {
  const std::lock_guard lock(mutex_);
  return most_registered_;
}

std::uint64_t FakeRuntime::allocated_bytes() {
  const std::lock_guard lock(mutex_);
  return sum(allocated_);
}

std::uint64_t FakeRuntime::calls(const std::string& function) {
  const std::lock_guard lock(mutex_);
  return calls_[function];
}

}  // namespace weir::test
