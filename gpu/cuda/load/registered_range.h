// A range of host memory that is page-locked for the device.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace weir {

/// Unlocks the range on destruction. No copy from it may be running then.
class RegisteredRange {
 public:
  enum class Use {
    copied,   ///< read by cudaMemcpyAsync
    in_place  ///< also read by kernels, at device_address()
  };
  /// Locks `range`, which has whole pages that may be mapped read-only. Returns nothing, with the reason in
  /// `refusal`, if the system does not lock this memory: the device or the system cannot, a limit is reached, or part
  /// of it is locked already. Throws Error(io) for other failures, including failures of earlier work.
  static std::optional<RegisteredRange> make(std::span<const std::byte> range, Use use, std::string& refusal);
  ~RegisteredRange();
  RegisteredRange(RegisteredRange&& other) noexcept;
  RegisteredRange& operator=(RegisteredRange&& other) noexcept;

  /// Returns the device's address of the range's first byte. Throws Error(io).
  const std::byte* device_address() const;
  /// Unlocks the range now. Throws Error(io).
  void release();

 private:
  explicit RegisteredRange(void* address) : address_(address) {}

  void* address_;
};

}  // namespace weir
