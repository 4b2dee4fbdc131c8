// Writes of several threads at once to a file in memory (tmpfs), where the kernel takes one write at a time.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

/// Bytes [0, size) of a file, all of which the file system has reserved: a thread that finds another one writing copies
/// its bytes into a mapping, meanwhile. Thread-safe but for begin() and end().
class ParallelWrites {
 public:
  ParallelWrites() = default;
  ~ParallelWrites() { end(); }
  ParallelWrites(const ParallelWrites&) = delete;
  ParallelWrites& operator=(const ParallelWrites&) = delete;

  /// Of the file behind `descriptor`, if that lies in memory; else, and where it cannot be mapped, write() does
  /// nothing.
  void begin(int descriptor, std::uint64_t size);
  /// The file may be cut after it: a page that is not there any more ends the process.
  void end();

  /// Calls `write()` where no other thread does so now, or `bytes` do not lie in the mapping; else copies them.
  template <typename Write>
  void write(std::uint64_t offset, std::span<const std::byte> bytes, const Write& write) {
    const Turn turn(writing_);
    if (turn.first() || !copy(offset, bytes)) write();
  }

 private:
  class Turn {
   public:
    explicit Turn(std::atomic<int>& writing) : writing_(writing), first_(writing.fetch_add(1) == 0) {}
    ~Turn() { writing_.fetch_sub(1); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    bool first() const { return first_; }

   private:
    std::atomic<int>& writing_;
    bool first_;
  };

  bool copy(std::uint64_t offset, std::span<const std::byte> bytes);

  std::span<std::byte> mapping_;
  std::atomic<int> writing_{0};
  std::atomic<std::size_t> resident_{0};  // bytes copied since pages were let go of: they count as the process's
};

}  // namespace weir
