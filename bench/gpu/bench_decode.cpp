// weir_bench_decode FILE.nvdb...: measures how fast the device decodes all blocks of packed files that have a stream
// into float values in its memory, beside the rate of copies within that memory. Also checks that the bits are those
// that the host decodes. "of all" counts the whole volume's values in that time, including blocks without a stream.
// Exits with 1 if bits differ, 2 for any other failure.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "bench/gpu/device_seconds.h"
#include "format/base/error.h"
#include "format/nanovdb/nvdb_file.h"
#include "gpu/cuda/packed/block_decoder.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {
namespace {

constexpr std::size_t kBatch = std::size_t{1} << 18U;  // blocks: 512 MiB of values

/// Returns all blocks with a stream, region by region.
std::vector<BlockId> blocks_of(const PackedData& packed) {
  std::vector<BlockId> blocks;
  const NodeLattice& regions = packed.regions();
  for (std::int64_t r = 0; r < regions.size(); ++r) {
    const PackedRegion region = packed.region(regions.position(r));
    if (region.chunk == 0) continue;
    packed.for_each_stream(region, [&](unsigned position, const PackedStream& stream) {
      if (stream.data != nullptr) blocks.push_back(static_cast<BlockId>(r) << 12U | position);
    });
  }
  return blocks;
}

/// Returns the number of blocks that the device decoded to other bits than the host.
std::size_t differing(const PackedData& packed, const std::vector<BlockId>& blocks, std::size_t first,
                      const std::vector<float>& values) {
  std::size_t different = 0;
  std::array<float, 512> expected;
  for (std::size_t i = 0; i * 512 < values.size(); ++i) {
    const BlockId id = blocks[first + i];
    const PackedRegion region = packed.region(packed.regions().position(static_cast<std::int64_t>(id >> 12U)));
    packed.decode(packed.stream(region, static_cast<unsigned>(id & 4095U)), expected);
    different += std::memcmp(expected.data(), values.data() + 512 * i, sizeof expected) != 0 ? 1 : 0;
  }
  return different;
}

bool measure(const std::string& path) {
  const NvdbFile file(path);
  const PackedData* packed = file.grid().packed();
  if (packed == nullptr) throw Error(ErrorKind::usage, path + ": is not packed");
  const std::vector<BlockId> blocks = blocks_of(*packed);
  BlockDecoder decoder(*packed);
  const DeviceArray<BlockId> ids{std::span<const BlockId>(blocks)};
  const std::size_t batch = std::min(kBatch, blocks.size());
  DeviceArray<float> values(512 * batch);
  DeviceArray<float> copy(512 * batch);

  std::size_t different = 0;
  BlockDecoder::Counts counts;
  std::vector<float> host;
  for (std::size_t first = 0; first < blocks.size(); first += batch) {
    const std::size_t count = std::min(batch, blocks.size() - first);
    decoder.decode(ids.data() + first, count, values.data(), cudaStreamPerThread);
    const BlockDecoder::Counts some = decoder.counts(cudaStreamPerThread);
    counts.damaged += some.damaged;
    counts.wide += some.wide;
    host.resize(512 * count);
    values.download(host);
    different += differing(*packed, blocks, first, host);
  }

  const double decode_s =
      device_seconds([&] { decoder.decode(ids.data(), batch, values.data(), cudaStreamPerThread); });
  const double copy_s = device_seconds([&] {
    check_cuda(cudaMemcpyAsync(copy.data(), values.data(), copy.bytes(), cudaMemcpyDeviceToDevice, cudaStreamPerThread),
               "copying on the device");
  });
  const double bytes = static_cast<double>(values.bytes());
  const double rate = bytes / decode_s / 1e9;
  const double copied = bytes / copy_s / 1e9;
  const auto voxels = static_cast<double>(packed->regions().domain.voxels());
  const double of_volume = rate * voxels / (512.0 * static_cast<double>(blocks.size()));
  const double bits = 8.0 * static_cast<double>(packed->bytes().size()) / (512.0 * static_cast<double>(blocks.size()));
  std::printf("%-28s %9zu %8.3f %9u %9.1f %9.1f %9.1f %7.3f %s\n", path.substr(path.rfind('/') + 1).c_str(),
              blocks.size(), bits, counts.wide, rate, of_volume, copied, rate / copied,
              different == 0 && counts.damaged == 0 ? "same" : "OTHER");
  std::fflush(stdout);
  if (different > 0 || counts.damaged > 0) {
    std::printf("  %zu blocks have other bits, %u are damaged\n", different, counts.damaged);
  }
  return different == 0 && counts.damaged == 0;
}

}  // namespace
}  // namespace weir

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw weir::Error(weir::ErrorKind::usage, "usage: weir_bench_decode FILE.nvdb...");
    std::printf("%-28s %9s %8s %9s %9s %9s %9s %7s %s\n", "file", "streams", "bits/v", "wide", "GB/s", "of all",
                "copy GB/s", "ratio", "bits");
    bool same = true;
    for (int i = 1; i < argc; ++i) same = weir::measure(argv[i]) && same;
    return same ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weir_bench_decode: %s\n", error.what());
    return 2;
  }
}
