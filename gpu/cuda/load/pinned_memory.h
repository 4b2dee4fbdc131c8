// Host memory that is page-locked for the device from its allocation on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace weir {

class PinnedMemory {
 public:
  /// Returns nothing, with the reason in `refusal`, if the system cannot lock the memory. Throws Error(io) for other
  /// failures, including failures of earlier work.
  static std::optional<PinnedMemory> make(std::uint64_t bytes, std::string& refusal);

  std::byte* data() const { return memory_.get(); }
  /// Gives the memory up without freeing it, because a device that was reset has already lost it.
  void forget() { static_cast<void>(memory_.release()); }
  /// Returns the device's address of the memory. Throws Error(io).
  const std::byte* device_address() const;

 private:
  struct Free {
    void operator()(std::byte* memory) const;
  };
  explicit PinnedMemory(std::byte* memory) : memory_(memory) {}

  std::unique_ptr<std::byte, Free> memory_;
};

}  // namespace weir
