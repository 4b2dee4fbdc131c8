// A range of host memory that is page-locked for the device.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace weir {

/// Unlocks on destruction: no copy from it may be under way then.
class RegisteredRange {
 public:
  enum class Use {
    copied,   ///< by cudaMemcpyAsync
    in_place  ///< read by kernels too, at device_address()
  };
  /// Locks `range`, whole pages that may be mapped read-only. Nothing, with the reason in `refusal`, where the system
  /// does not lock this memory: the device or the system cannot, a limit is reached, or part of it is locked already.
  /// Throws Error(io) for other failures, those of earlier work among them.
  static std::optional<RegisteredRange> make(std::span<const std::byte> range, Use use, std::string& refusal);
  ~RegisteredRange();
  RegisteredRange(RegisteredRange&& other) noexcept;
  RegisteredRange& operator=(RegisteredRange&& other) noexcept;

  /// Where the device sees the range's first byte. Throws Error(io).
  const std::byte* device_address() const;
  /// Unlocks now. Throws Error(io).
  void release();

 private:
  explicit RegisteredRange(void* address) : address_(address) {}

  void* address_;
};

}  // namespace weir
