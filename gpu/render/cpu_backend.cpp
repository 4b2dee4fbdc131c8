#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/process/process_memory.h"
#include "gpu/render/backend.h"
#include "gpu/render/cpu_renderer.h"
#include "gpu/volume/leaf_table.h"
#include "gpu/volume/mean_pyramid.h"

namespace weir {

namespace {

class CpuVolume : public LoadedVolume {
 public:
  virtual Picture render(const Scene& scene, const RenderOptions& options, const CpuRenderOptions& sampling) = 0;
};

// The voxels of a mapped file. The leaves are read in the mapping, or decoded if the file is packed.
struct FileVoxels {
  std::shared_ptr<const NvdbFile> file;
  LeafTable table;

  MeanPyramid pyramid(int first, int threads) const {
    return {file->grid().index_bbox(), table.view(), first, threads};
  }
  // `seen(sampler)` returns the volume that is rendered.
  template <class Seen>
  Image render(const RenderSetup& setup, Filter filter, const CpuRenderOptions& sampling, CacheCounts& /*counts*/,
               const Seen& seen) const {
    return render_cpu(setup.task(seen(VolumeSampler{table.view(), filter})), sampling);
  }
};

struct DenseVoxels {
  std::shared_ptr<const DenseVolume> volume;

  MeanPyramid pyramid(int first, int threads) const { return {volume->frame().domain, volume->view(), first, threads}; }
  template <class Seen>
  Image render(const RenderSetup& setup, Filter filter, const CpuRenderOptions& sampling, CacheCounts& /*counts*/,
               const Seen& seen) const {
    return render_cpu(setup.task(seen(DenseSampler{volume->view(), filter})), sampling);
  }
};

// The voxels of a packed file whose decoded blocks do not fit into memory.
struct CachedVoxels {
  std::shared_ptr<const NvdbFile> file;
  std::unique_ptr<CachedBlocks> blocks;

  MeanPyramid pyramid(int first, int threads) const { return {file->grid().index_bbox(), *blocks, first, threads}; }
  template <class Seen>
  Image render(const RenderSetup& setup, Filter filter, const CpuRenderOptions& sampling, CacheCounts& counts,
               const Seen& seen) const {
    using Volume = decltype(seen(std::declval<CachedSampler>()));
    std::vector<BlockReader> readers(render_threads(sampling.threads), BlockReader(*blocks));
    std::vector<RenderTask<Volume>> tasks;
    tasks.reserve(readers.size());
    for (BlockReader& reader : readers) tasks.push_back(setup.task(seen(CachedSampler{reader, filter})));
    Image image = render_cpu(std::span<const RenderTask<Volume>>(tasks), sampling);
    for (const BlockReader& reader : readers) counts += reader.counts();
    return image;
  }
};

template <class Voxels>
class CpuVolumeOf : public CpuVolume {
 public:
  // Levels of detail take at most `level_bytes`.
  CpuVolumeOf(Voxels voxels, MacrocellGrid cells, const VolumeInfo& info, const LoadSummary& summary,
              std::uint64_t level_bytes)
      : voxels_(std::move(voxels)),
        cells_(std::move(cells)),
        info_(info),
        summary_(summary),
        level_bytes_(level_bytes) {}

  const VolumeInfo& info() const override { return info_; }
  const LoadSummary& load_summary() const override { return summary_; }

  Picture render(const Scene& scene, const RenderOptions& options, const CpuRenderOptions& sampling) override {
    RenderSetup setup(info_, cells_, scene, options);
    Picture picture;
    const auto start = std::chrono::steady_clock::now();
    if (const MeanPyramid* levels = pyramid(setup, sampling.threads, picture.levels_note)) {
      setup.bound_cells(levels->bounds(cells_, setup.levels()->choice, sampling.threads));
      const LevelsView<DenseSampler> view = levels->view();
      const auto seen = [&]<class Fine>(const Fine& fine) {
        return LevelledVolume<Fine, DenseSampler>{fine, view, setup.levels()->choice};
      };
      picture.image = voxels_.render(setup, options.filter, sampling, picture.cache, seen);
      picture.finest_level = levels->first();
    } else {
      picture.image =
          voxels_.render(setup, options.filter, sampling, picture.cache, [](const auto& fine) { return fine; });
    }
    picture.render_s = seconds_since(start);
    picture.tone = setup.tone();
    return picture;
  }

 private:
  // Returns null if the picture has no use for levels. The pyramid is kept for the next picture that needs the same
  // levels.
  const MeanPyramid* pyramid(const RenderSetup& setup, int threads, std::string& note) {
    if (!setup.levels()) return nullptr;
    const int first = finest_level_within(level_lattice(info_.frame.domain), setup.levels()->finest, level_bytes_);
    note = levels_note(first, setup.levels()->finest, setup.levels()->coarsest);
    if (!levels_are_of_use(first, setup.levels()->coarsest)) return nullptr;
    if (!pyramid_ || pyramid_->first() != first) {
      pyramid_.reset();
      pyramid_.emplace(voxels_.pyramid(first, threads));
    }
    return &*pyramid_;
  }

  Voxels voxels_;
  MacrocellGrid cells_;
  VolumeInfo info_;
  LoadSummary summary_;
  std::uint64_t level_bytes_;
  std::optional<MeanPyramid> pyramid_;
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
      return volume_of(CachedVoxels{file, std::move(blocks)}, *file, cell, summary, plan.level_bytes);
    }
    LeafTable table(grid);
    const LoadSummary summary{grid.packed() != nullptr ? "decoded" : "mapped", grid.data_bytes(), 0, "", table.bytes()};
    return volume_of(FileVoxels{file, std::move(table)}, *file, cell, summary, plan.level_bytes);
  }

  std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume> volume, std::int64_t cell) override {
    MacrocellGrid cells = macrocells_of(*volume, cell_or_default(cell));
    const VolumeInfo info{volume->frame(), volume->range(), volume->background()};
    const LoadSummary summary{"memory", volume->bytes(), 0, "", volume->bytes() + cells.bytes()};
    return std::make_unique<CpuVolumeOf<DenseVoxels>>(DenseVoxels{std::move(volume)}, std::move(cells), info, summary,
                                                      memory_.ceiling.value_or(available_bytes()) / 8);
  }

  Picture render(LoadedVolume& volume, const Scene& scene, const RenderOptions& options,
                 const SampleOptions& sampling) override {
    return static_cast<CpuVolume&>(volume).render(scene, options, {sampling, threads_});
  }

 private:
  static std::int64_t cell_or_default(std::int64_t cell) { return cell == 0 ? kMacrocell : cell; }

  // `summary` does not yet count the macrocells.
  template <class Voxels>
  static std::unique_ptr<LoadedVolume> volume_of(Voxels voxels, const NvdbFile& file, std::int64_t cell,
                                                 LoadSummary summary, std::uint64_t level_bytes) {
    MacrocellGrid cells(file.grid(), cell_or_default(cell));
    const VolumeInfo info = volume_info(file.grid(), cells);
    summary.memory += cells.bytes();
    return std::make_unique<CpuVolumeOf<Voxels>>(std::move(voxels), std::move(cells), info, summary, level_bytes);
  }

  int threads_;
  VoxelMemory memory_;
};

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(int threads, const VoxelMemory& memory) {
  return std::make_unique<CpuBackend>(threads, memory);
}

}  // namespace weir
