#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "gpu/render/backend.h"
#include "gpu/render/cpu_renderer.h"
#include "gpu/volume/leaf_table.h"

namespace weir {

namespace {

class CpuVolume : public LoadedVolume {
 public:
  virtual Picture render(const Scene& scene, const RenderOptions& options, const CpuRenderOptions& sampling) const = 0;
};

// The voxels of a mapped file: the leaves stay where they are, or are decoded.
struct FileVoxels {
  std::shared_ptr<const NvdbFile> file;
  LeafTable table;

  Image render(const RenderSetup& setup, Filter filter, const CpuRenderOptions& sampling, CacheCounts&) const {
    return render_cpu(setup.task(VolumeSampler{table.view(), filter}), sampling);
  }
};

struct DenseVoxels {
  std::shared_ptr<const DenseVolume> volume;

  Image render(const RenderSetup& setup, Filter filter, const CpuRenderOptions& sampling, CacheCounts&) const {
    return render_cpu(setup.task(DenseSampler{volume->view(), filter}), sampling);
  }
};

// The voxels of a packed file that do not fit into memory.
struct CachedVoxels {
  std::shared_ptr<const NvdbFile> file;
  std::unique_ptr<CachedBlocks> blocks;

  Image render(const RenderSetup& setup, Filter filter, const CpuRenderOptions& sampling, CacheCounts& counts) const {
    std::vector<BlockReader> readers(render_threads(sampling.threads), BlockReader(*blocks));
    std::vector<RenderTask<CachedSampler>> tasks;
    tasks.reserve(readers.size());
    for (BlockReader& reader : readers) tasks.push_back(setup.task(CachedSampler{reader, filter}));
    Image image = render_cpu(std::span<const RenderTask<CachedSampler>>(tasks), sampling);
    for (const BlockReader& reader : readers) counts += reader.counts();
    return image;
  }
};

template <class Voxels>
class CpuVolumeOf : public CpuVolume {
 public:
  CpuVolumeOf(Voxels voxels, MacrocellGrid cells, const VolumeInfo& info, const LoadSummary& summary)
      : voxels_(std::move(voxels)), cells_(std::move(cells)), info_(info), summary_(summary) {}

  const VolumeInfo& info() const override { return info_; }
  const LoadSummary& load_summary() const override { return summary_; }

  Picture render(const Scene& scene, const RenderOptions& options, const CpuRenderOptions& sampling) const override {
    const RenderSetup setup(info_, cells_, scene, options);
    Picture picture;
    const auto start = std::chrono::steady_clock::now();
    picture.image = voxels_.render(setup, options.filter, sampling, picture.cache);
    picture.render_s = seconds_since(start);
    picture.tone = setup.tone();
    return picture;
  }

 private:
  Voxels voxels_;
  MacrocellGrid cells_;
  VolumeInfo info_;
  LoadSummary summary_;
};

class CpuBackend : public Backend {
 public:
  CpuBackend(int threads, const VoxelMemory& memory) : threads_(threads), memory_(memory) {}

  std::string_view name() const override { return "cpu"; }

  std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile> file, std::int64_t cell,
                                     std::unique_ptr<LoadedVolume> reuse) override {
    reuse.reset();
    const NvdbGrid& grid = file->grid();
    const VoxelPlan plan = plan_voxels(grid, memory_);
    if (plan.cache_bytes) {
      auto blocks = std::make_unique<CachedBlocks>(grid, *plan.cache_bytes);
      const LoadSummary summary{"cached", grid.data_bytes(), 0,
                                cat("all blocks decoded take ", format_bytes(plan.decoded_bytes),
                                    ", so they go through a cache, more slowly"),
                                blocks->bytes()};
      return volume_of(CachedVoxels{file, std::move(blocks)}, *file, cell, summary);
    }
    LeafTable table(grid);
    const LoadSummary summary{grid.packed() != nullptr ? "decoded" : "mapped", grid.data_bytes(), 0, "", table.bytes()};
    return volume_of(FileVoxels{file, std::move(table)}, *file, cell, summary);
  }

  std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume> volume, std::int64_t cell) override {
    MacrocellGrid cells = macrocells_of(*volume, cell_or_default(cell));
    const VolumeInfo info{volume->frame(), volume->range(), volume->background()};
    const LoadSummary summary{"memory", volume->bytes(), 0, "", volume->bytes() + cells.bytes()};
    return std::make_unique<CpuVolumeOf<DenseVoxels>>(DenseVoxels{std::move(volume)}, std::move(cells), info, summary);
  }

  Picture render(LoadedVolume& volume, const Scene& scene, const RenderOptions& options,
                 const SampleOptions& sampling) override {
    return static_cast<const CpuVolume&>(volume).render(scene, options, {sampling, threads_});
  }

 private:
  static std::int64_t cell_or_default(std::int64_t cell) { return cell == 0 ? kMacrocell : cell; }

  // `summary` is without the macrocells.
  template <class Voxels>
  static std::unique_ptr<LoadedVolume> volume_of(Voxels voxels, const NvdbFile& file, std::int64_t cell,
                                                 LoadSummary summary) {
    MacrocellGrid cells(file.grid(), cell_or_default(cell));
    const VolumeInfo info = volume_info(file.grid(), cells);
    summary.memory += cells.bytes();
    return std::make_unique<CpuVolumeOf<Voxels>>(std::move(voxels), std::move(cells), info, summary);
  }

  int threads_;
  VoxelMemory memory_;
};

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(int threads, const VoxelMemory& memory) {
  return std::make_unique<CpuBackend>(threads, memory);
}

}  // namespace weir
