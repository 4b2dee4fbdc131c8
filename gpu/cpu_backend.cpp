#include <chrono>
#include <utility>

#include "gpu/backend.h"
#include "gpu/cpu_renderer.h"
#include "gpu/leaf_table.h"

namespace weir {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class CpuVolume : public LoadedVolume {
 public:
  CpuVolume(std::shared_ptr<const NvdbFile> file, std::int64_t cell)
      : file_(std::move(file)),
        table_(file_->grid()),
        cells_(file_->grid(), cell),
        info_(volume_info(file_->grid(), cells_)) {
    summary_.way = "mapped";
    summary_.bytes = file_->grid().data_bytes();
  }

  const VolumeInfo& info() const override { return info_; }
  const LoadSummary& load_summary() const override { return summary_; }
  const MacrocellGrid& cells() const { return cells_; }
  LeafTableView table() const { return table_.view(); }

 private:
  std::shared_ptr<const NvdbFile> file_;
  LeafTable table_;
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
    return std::make_unique<CpuVolume>(std::move(file), cell == 0 ? kMacrocell : cell);
  }

  Picture render(LoadedVolume& volume, const Scene& scene, const RenderOptions& options,
                 const SampleOptions& sampling) override {
    const auto& loaded = static_cast<const CpuVolume&>(volume);
    const RenderSetup setup(loaded.info(), loaded.cells(), scene, options);
    const auto start = std::chrono::steady_clock::now();
    Image image = render_cpu(setup.task(VolumeSampler{loaded.table(), options.filter}),
                             {sampling.samples, threads_, sampling.cancel, sampling.progress});
    return {std::move(image), setup.tone(), seconds_since(start)};
  }

 private:
  int threads_;
};

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(int threads) { return std::make_unique<CpuBackend>(threads); }

}  // namespace weir
