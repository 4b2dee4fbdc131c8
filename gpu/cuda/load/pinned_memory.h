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
  /// Nothing, with the reason in `refusal`, where the system has none to lock. Throws Error(io) for other failures,
  /// those of earlier work among them.
  static std::optional<PinnedMemory> make(std::uint64_t bytes, std::string& refusal);

  std::byte* data() const { return memory_.get(); }
  /// It is not freed: a device that was reset has none.
  void forget() { static_cast<void>(memory_.release()); }
  /// Where the device sees it. Throws Error(io).
  const std::byte* device_address() const;

 private:
  struct Free {
    void operator()(std::byte* memory) const;
  };
  explicit PinnedMemory(std::byte* memory) : memory_(memory) {}

  std::unique_ptr<std::byte, Free> memory_;
};

}  // namespace weir
