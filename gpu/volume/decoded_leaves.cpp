#include "gpu/volume/decoded_leaves.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <thread>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/packed_blocks.h"
#include "format/process/process_memory.h"

namespace weir {
namespace {

// Calls work(i) for 0 <= i < count on all threads of the machine. Throws what one of them threw. Does not use TBB, so
// that programs that embed the renderer need no library.
template <class Work>
void for_all(std::int64_t count, const Work& work) {
  std::atomic<std::int64_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto run = [&] {
    try {
      for (std::int64_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      const std::scoped_lock lock(mutex);
      error = std::current_exception();
    }
  };
  const auto threads = std::min<std::int64_t>(count, std::max(1U, std::thread::hardware_concurrency()));
  {
    std::vector<std::jthread> others;
    for (std::int64_t i = 1; i < threads; ++i) others.emplace_back(run);
    run();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace

std::vector<std::uint64_t> coded_blocks(const PackedData& packed) {
  const NodeLattice& regions = packed.regions();
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(regions.size()));
  for_all(regions.size(), [&](std::int64_t region) {
    for_each_packed_block(packed, regions.position(region), [&](const GridBlock& block) {
      counts[static_cast<std::size_t>(region)] += block.coded() ? 1 : 0;
    });
  });
  return counts;
}

DecodedLeaves::DecodedLeaves(const NvdbGrid& grid) : first_(coded_blocks(*grid.packed())) {
  for (std::uint64_t& first : first_) {
    const std::uint64_t blocks = first;
    first = count_;
    count_ += blocks;
  }
  if (count_ == 0) return;
  if (const std::uint64_t available = available_bytes(); bytes() > available) {
    throw Error(ErrorKind::input,
                compose("the grid is packed, and its ", count_, " coded blocks take ", format_bytes(bytes()),
                        " of memory to render, where ", format_bytes(available), " are available; convert it with ",
                        option("encoding", "fpn"), " or a part of it with ", option("roi")));
  }
  leaves_.reset(static_cast<std::byte*>(std::aligned_alloc(nvdb::kAlignment, bytes())));
  if (!leaves_) throw std::bad_alloc();
  for_all(grid.packed()->regions().size(), [&](std::int64_t region) { decode_region(grid, region); });
}

std::uint64_t DecodedLeaves::bytes() const { return count_ * nvdb::kFloatLeafBytes; }

void DecodedLeaves::decode_region(const NvdbGrid& grid, std::int64_t region) {
  std::byte* leaf = leaves_.get() + first_[static_cast<std::size_t>(region)] * nvdb::kFloatLeafBytes;
  std::array<float, kLeafVoxels> values;
  for_each_packed_block(*grid.packed(), grid.packed()->regions().position(region), [&](const GridBlock& block) {
    if (!block.coded()) return;
    grid.decode_block(block, values);
    std::memcpy(leaf + nvdb::leaf::kValues, values.data(), sizeof values);
    leaf += nvdb::kFloatLeafBytes;
  });
}

void DecodedLeaves::for_each(const NvdbGrid& grid,
                             const std::function<void(const GridBlock&, std::uint64_t)>& visit) const {
  std::uint64_t number = 0;
  grid.for_each_block([&](const GridBlock& block) {
    if (block.coded()) visit(block, number++);
  });
}

}  // namespace weir
