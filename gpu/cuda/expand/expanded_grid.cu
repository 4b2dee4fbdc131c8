#include "gpu/cuda/expand/expanded_grid.h"

#include <algorithm>
#include <vector>

#include "format/base/error.h"
#include "format/base/message.h"
#include "format/layout/nvdb_type.h"
#include "format/nanovdb/expanded_tree.h"
#include "gpu/cuda/bricks/device_machine.cuh"
#include "gpu/cuda/expand/leaf_steps.h"
#include "gpu/cuda/packed/block_decoder.h"

namespace weir {

namespace {

constexpr std::size_t kBlocksTogether = std::size_t{1} << 17U;  // enough to keep a device busy; 256 MiB of values

/// Collects neighbouring pieces of a grid's bytes, so that they cross the bus in large copies.
class GridUpload {
 public:
  explicit GridUpload(std::byte* grid) : grid_(grid) { bytes_.reserve(kPiece); }

  void add(std::uint64_t offset, std::span<const std::byte> bytes) {
    if (offset != offset_ + bytes_.size() || bytes_.size() + bytes.size() > kPiece) {
      flush();
      offset_ = offset;
    }
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  void flush() {
    if (!bytes_.empty()) {
      check_cuda(
          cudaMemcpyAsync(grid_ + offset_, bytes_.data(), bytes_.size(), cudaMemcpyHostToDevice, cudaStreamPerThread),
          "copying the tree to the device");
      check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "copying the tree to the device");
    }
    bytes_.clear();
  }

 private:
  static constexpr std::size_t kPiece = std::size_t{8} << 20U;

  std::byte* grid_;
  std::uint64_t offset_ = 0;
  std::vector<std::byte> bytes_;
};

/// Writes the leaves. Returns their statistics.
std::vector<LeafStatistics> write_leaves(const NvdbGrid& grid, const std::byte* packed, const ExpandedTree& tree,
                                         bool quantised, std::byte* leaves) {
  const DeviceMachine machine;
  const std::span<const std::uint64_t> blocks = tree.blocks();
  BlockDecoder decoder(*grid.packed(), packed + (grid.packed()->bytes().data() - grid.data().data()));
  const std::size_t together = std::min(kBlocksTogether, blocks.size());
  DeviceArray<BlockId> listed(together);
  DeviceArray<float> values(512 * together);
  DeviceArray<LeafStatistics> statistics(blocks.size());
  const Index3 corner = grid.packed()->regions().first * kRegionDim;
  WriteLeaves step;
  step.lattice = block_lattice(grid.index_bbox());
  step.corner = narrow(corner);
  step.background = grid.background();
  step.quantised = quantised;
  step.blocks = listed.data();
  step.values = values.data();
  const std::uint64_t leaf_bytes = ExpandedTree::leaf_bytes(quantised ? GridType::fp16 : GridType::float32);
  for (std::size_t first = 0; first < blocks.size(); first += together) {
    const std::size_t some = std::min(together, blocks.size() - first);
    listed.upload(blocks.subspan(first, some));
    decoder.decode(listed.data(), some, values.data(), cudaStreamPerThread);
    step.leaves = leaves + first * leaf_bytes;
    step.statistics = statistics.data() + first;
    machine.groups(static_cast<std::uint32_t>(some), step);
  }
  if (const std::uint32_t damaged = decoder.counts(cudaStreamPerThread).damaged; damaged > 0) {
    throw Error(ErrorKind::input,
                cat(grid.packed()->path(), ": ", damaged, " packed blocks are damaged; see weir verify"));
  }
  return statistics.download();
}

}  // namespace

DeviceGrid load_grid_as(const NvdbFile& file, GridType as, DeviceBuffer&& buffer, const LoadOptions& options,
                        cudaStream_t stream) {
  if (as != GridType::float32 && as != GridType::fp16) {
    throw Error(ErrorKind::usage, cat("a grid is expanded to float32 or fp16, not to ", grid_type_name(as)));
  }
  const NvdbGrid& grid = file.grid();
  if (grid.packed() == nullptr) {
    if (grid.type() == as) return load_grid(file, std::move(buffer), options, stream);
    throw Error(ErrorKind::input, cat(file.path(), ": is a grid of ", grid_type_name(grid.type()), ", not ",
                                      grid_type_name(as), "; load it as it is: packed grids alone are expanded"));
  }
  LoadOptions how = options;
  how.packed = true;
  const DeviceGrid packed = load_grid(file, {}, how, stream);
  LoadReport report = packed.report();
  {
    const StageClock clock(report.seconds);
    const ExpandedTree tree(grid, as);
    buffer.reserve(tree.bytes());
    const std::vector<LeafStatistics> leaves =
        write_leaves(grid, packed.data(), tree, as == GridType::fp16, buffer.data() + tree.leaf_offset());
    GridUpload upload(buffer.data());
    tree.write(leaves, [&](std::uint64_t offset, std::span<const std::byte> bytes) { upload.add(offset, bytes); });
    upload.flush();
    file.mapping().check_unchanged();
    report.bytes = tree.bytes();
  }
  report.zero_copy = false;
  return DeviceGrid(std::move(buffer), report);
}

}  // namespace weir
