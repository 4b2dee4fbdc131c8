#include <chrono>
#include <utility>

#include "format/base/seconds_since.h"
#include "gpu/render/backend.h"
#include "gpu/render/cpu_renderer.h"
#include "gpu/volume/leaf_table.h"

namespace weir {

namespace {

class CpuVolume : public LoadedVolume {
 public:
  virtual Picture render(const Scene& scene, const RenderOptions& options, const CpuRenderOptions& sampling) const = 0;
};

// The voxels of a mapped file: the leaves stay where they are.
struct FileVoxels {
  std::shared_ptr<const NvdbFile> file;
  LeafTable table;

  VolumeSampler sampler(Filter filter) const { return {table.view(), filter}; }
};

struct DenseVoxels {
  std::shared_ptr<const DenseVolume> volume;

  DenseSampler sampler(Filter filter) const { return {volume->view(), filter}; }
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
    const auto start = std::chrono::steady_clock::now();
    Image image = render_cpu(setup.task(voxels_.sampler(options.filter)), sampling);
    return {std::move(image), setup.tone(), seconds_since(start)};
  }

 private:
  Voxels voxels_;
  MacrocellGrid cells_;
  VolumeInfo info_;
  LoadSummary summary_;
};

class CpuBackend : public Backend {
 public:
  explicit CpuBackend(int threads) : threads_(threads) {}

  std::string_view name() const override { return "cpu"; }

  std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile> file, std::int64_t cell,
                                     std::unique_ptr<LoadedVolume> reuse) override {
    reuse.reset();
    const NvdbGrid& grid = file->grid();
    LeafTable table(grid);
    MacrocellGrid cells(grid, cell_or_default(cell));
    const VolumeInfo info = volume_info(grid, cells);
    const LoadSummary summary{grid.packed() != nullptr ? "decoded" : "mapped", grid.data_bytes(), 0, ""};
    return std::make_unique<CpuVolumeOf<FileVoxels>>(FileVoxels{std::move(file), std::move(table)}, std::move(cells),
                                                     info, summary);
  }

  std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume> volume, std::int64_t cell) override {
    MacrocellGrid cells = macrocells_of(*volume, cell_or_default(cell));
    const VolumeInfo info{volume->frame(), volume->range(), volume->background()};
    const LoadSummary summary{"memory", volume->bytes(), 0, ""};
    return std::make_unique<CpuVolumeOf<DenseVoxels>>(DenseVoxels{std::move(volume)}, std::move(cells), info, summary);
  }

  Picture render(LoadedVolume& volume, const Scene& scene, const RenderOptions& options,
                 const SampleOptions& sampling) override {
    return static_cast<const CpuVolume&>(volume).render(scene, options, {sampling, threads_});
  }

 private:
  static std::int64_t cell_or_default(std::int64_t cell) { return cell == 0 ? kMacrocell : cell; }

  int threads_;
};

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(int threads) { return std::make_unique<CpuBackend>(threads); }

}  // namespace weir
