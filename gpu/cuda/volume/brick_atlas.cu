#include <cub/device/device_scan.cuh>

#include "format/base/error.h"
#include "gpu/cuda/volume/brick_atlas.h"
#include "gpu/cuda/volume/device_memory.h"

namespace weir {

namespace {

constexpr int kThreads = 256;
constexpr std::int32_t kBrickVoxels = kBrickEdge * kBrickEdge * kBrickEdge;
constexpr std::uint32_t kMaxAcross = kMaxTextureEdge / kBrickEdge;  // bricks along x and y
constexpr std::uint32_t kMaxLayers = 1023;                          // along z: an entry's bits

/// Bricks along each axis of the texture; brick (0, 0, 0) stays empty, since its entry means none.
struct AtlasShape {
  std::uint32_t x = 1;
  std::uint32_t y = 1;
  std::uint32_t z = 1;

  std::uint64_t size() const { return static_cast<std::uint64_t>(x) * y * z; }
};

AtlasShape shape_for(std::uint64_t bricks) {
  AtlasShape shape;
  while (shape.size() < bricks + 1) {
    std::uint32_t* shortest = nullptr;
    const auto consider = [&](std::uint32_t& edge, std::uint32_t limit) {
      if (edge < limit && (shortest == nullptr || edge < *shortest)) shortest = &edge;
    };
    consider(shape.x, kMaxAcross);
    consider(shape.y, kMaxAcross);
    consider(shape.z, kMaxLayers);
    if (shortest == nullptr) {
      throw Error(ErrorKind::input, "the grid has more leaves than a brick atlas holds; use --filter stochastic");
    }
    ++*shortest;
  }
  return shape;
}

template <class Block>
std::int64_t blocks_of(const BlockTable<Block>& table) {
  return static_cast<std::int64_t>(table.count.x) * table.count.y * table.count.z;
}

template <class Block>
__device__ Int3 position_of(const BlockTable<Block>& table, std::int64_t at) {
  return {static_cast<std::int32_t>(at % table.count.x), static_cast<std::int32_t>(at / table.count.x % table.count.y),
          static_cast<std::int32_t>(at / (static_cast<std::int64_t>(table.count.x) * table.count.y))};
}

/// 1 where a block needs a brick: it or one of the seven above it is a leaf, or has another value.
template <class Block>
__global__ void flag_bricks(BlockTable<Block> table, std::int64_t count, std::uint32_t* flags) {
  const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (i >= count) return;
  const Int3 b = position_of(table, i);
  const auto bits = __float_as_uint(table.blocks[i].tile_value());
  bool uniform = true;
  for (int k = 0; k < 8; ++k) {
    const Int3 above{lesser(b.x + (k & 1), table.count.x - 1), lesser(b.y + (k >> 1 & 1), table.count.y - 1),
                     lesser(b.z + (k >> 2), table.count.z - 1)};
    const Block& block = table.blocks[table.index(above)];
    uniform = uniform && block.units == 0 && __float_as_uint(block.tile_value()) == bits;
  }
  flags[i] = uniform ? 0 : 1;
}

/// `ranks` count the bricks up to and with each block; brick ranks follow the texture's x first.
template <class Block>
__global__ void place(BlockTable<Block> table, std::int64_t count, const std::uint32_t* ranks, AtlasShape shape,
                      BrickEntry* entries) {
  const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (i >= count) return;
  const std::uint32_t rank = ranks[i];
  const bool has_brick = rank != (i == 0 ? 0 : ranks[i - 1]);
  entries[i] = {has_brick ? BrickEntry::pack(rank % shape.x, rank / shape.x % shape.y, rank / (shape.x * shape.y)) : 0,
                table.blocks[i].tile_value()};
}

/// One block of threads a block of voxels.
template <class Block>
__global__ void fill(BlockTable<Block> table, const BrickEntry* entries, cudaSurfaceObject_t surface) {
  const std::int64_t at = blockIdx.x;
  const BrickEntry entry = entries[at];
  if (entry.brick == 0) return;
  const Int3 b = position_of(table, at);
  const Int3 corner = entry.corner();
  for (std::int32_t i = static_cast<std::int32_t>(threadIdx.x); i < kBrickVoxels; i += kThreads) {
    // z fastest, as leaves have it.
    const Int3 v{i / (kBrickEdge * kBrickEdge), i / kBrickEdge % kBrickEdge, i % kBrickEdge};
    const Int3 voxel{clamped(8 * b.x + v.x - table.shift.x, 0, table.extent.x - 1),
                     clamped(8 * b.y + v.y - table.shift.y, 0, table.extent.y - 1),
                     clamped(8 * b.z + v.z - table.shift.z, 0, table.extent.z - 1)};
    surf3Dwrite(table.voxel(voxel), surface, (corner.x + v.x) * static_cast<std::int32_t>(sizeof(float)),
                corner.y + v.y, corner.z + v.z);
  }
}

}  // namespace

template <class Block>
BrickAtlas::BrickAtlas(const BlockTable<Block>& table, std::uint64_t spare) {
  const cudaStream_t stream = cudaStreamPerThread;
  const std::int64_t count = blocks_of(table);
  const auto launched = static_cast<unsigned>((count + kThreads - 1) / kThreads);
  const DeviceArray<std::uint32_t> ranks(static_cast<std::size_t>(count));
  flag_bricks<<<launched, kThreads, 0, stream>>>(table, count, ranks.data());
  std::size_t scratch_bytes = 0;
  check_cuda(cub::DeviceScan::InclusiveSum(nullptr, scratch_bytes, ranks.data(), ranks.data(), count, stream),
             "preparing a scan");
  const DeviceArray<std::byte> scratch(scratch_bytes);
  check_cuda(cub::DeviceScan::InclusiveSum(scratch.data(), scratch_bytes, ranks.data(), ranks.data(), count, stream),
             "counting bricks");
  std::uint32_t bricks = 0;
  check_cuda(cudaMemcpyAsync(&bricks, ranks.data() + count - 1, sizeof bricks, cudaMemcpyDeviceToHost, stream),
             "counting bricks");
  check_cuda(cudaStreamSynchronize(stream), "counting bricks");
  bricks_ = bricks;

  const AtlasShape shape = shape_for(bricks);
  const std::uint64_t needed =
      shape.size() * kBrickVoxels * sizeof(float) + static_cast<std::uint64_t>(count) * sizeof(BrickEntry);
  const std::uint64_t free = free_device_bytes(needed + spare);
  if (needed + spare > free) {
    throw Error(ErrorKind::io, cat("a brick atlas needs ", format_bytes(needed), " of device memory, ",
                                   format_bytes(free), " are free"));
  }
  entries_ = DeviceArray<BrickEntry>(static_cast<std::size_t>(count));
  const auto edge = [](std::uint32_t n) { return static_cast<std::int32_t>(n) * kBrickEdge; };
  texture_ = Texture({edge(shape.x), edge(shape.y), edge(shape.z)});
  place<<<launched, kThreads, 0, stream>>>(table, count, ranks.data(), shape, entries_.data());
  fill<<<static_cast<unsigned>(count), kThreads, 0, stream>>>(table, entries_.data(), texture_.surface());
  check_cuda(cudaGetLastError(), "building the brick atlas");
  check_cuda(cudaStreamSynchronize(stream), "building the brick atlas");
  sampler_ = {entries_.data(), texture_.object(), table.count, table.shift, table.extent};
}

template BrickAtlas::BrickAtlas(const BlockTable<FloatBlock>&, std::uint64_t);
template BrickAtlas::BrickAtlas(const BlockTable<QuantisedBlock>&, std::uint64_t);

}  // namespace weir
