#include "gpu/cuda/render/cuda_backend.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <mutex>
#include <utility>

#include "format/base/error.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "gpu/cuda/render/render_kernel.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/volume/dense_texture.h"
#include "gpu/cuda/volume/device_environment.h"
#include "gpu/cuda/volume/device_memory.h"
#include "gpu/cuda/volume/device_samplers.h"
#include "gpu/cuda/volume/device_volume.h"

namespace weir {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLaunchSeconds = 0.05;  // how long one launch may keep a cancellation waiting, roughly

/// Why a grid cannot lie on the current device, of which `held` bytes are kept for it already; "" where it can.
std::string reason_for_zero_copy(const NvdbGrid& grid, std::uint64_t held) {
  const auto blocks = static_cast<std::uint64_t>(leaf_lattice(grid.index_bbox()).size());
  const std::uint64_t table = blocks * (grid.type() == GridType::float32 ? sizeof(FloatBlock) : sizeof(QuantisedBlock));
  const std::uint64_t needed = grid.data_bytes() + table + kSpareDeviceBytes;
  const std::uint64_t there = free_device_bytes(needed > held ? needed - held : 0) + held;
  if (needed <= there) return "";
  return cat("the grid needs ", format_bytes(needed), " of device memory and ", format_bytes(there),
             " are free, so it stays in host memory");
}

/// A file's grid, or a dense volume, on every device of the back end, in its order.
class CudaVolume : public LoadedVolume {
 public:
  CudaVolume(std::shared_ptr<const NvdbFile> file, std::vector<std::unique_ptr<DeviceVolume>> grids,
             MacrocellGrid cells, LoadSummary summary)
      : file_(std::move(file)),
        grids_(std::move(grids)),
        cells_(std::move(cells)),
        info_(volume_info(file_->grid(), cells_)),
        summary_(std::move(summary)) {}
  CudaVolume(const VolumeInfo& info, std::vector<std::unique_ptr<DenseTexture>> textures, MacrocellGrid cells,
             LoadSummary summary)
      : textures_(std::move(textures)), cells_(std::move(cells)), info_(info), summary_(std::move(summary)) {}

  const VolumeInfo& info() const override { return info_; }
  const LoadSummary& load_summary() const override { return summary_; }
  const MacrocellGrid& cells() const { return cells_; }
  bool dense() const { return !textures_.empty(); }
  DeviceVolume& grid(std::size_t i) { return *grids_[i]; }
  DenseTexture& texture(std::size_t i) { return *textures_[i]; }

 private:
  std::shared_ptr<const NvdbFile> file_;  ///< kept: a zero-copy grid lies in its mapping
  std::vector<std::unique_ptr<DeviceVolume>> grids_;
  std::vector<std::unique_ptr<DenseTexture>> textures_;
  MacrocellGrid cells_;
  VolumeInfo info_;
  LoadSummary summary_;
};

/// One device's part of a picture.
struct Share {
  int device = 0;
  std::uint32_t first = 0;  ///< samples [first, last)
  std::uint32_t last = 0;
};

/// Samples in turns that grow until one takes kLaunchSeconds; `launch` starts [first, last) on the default stream.
template <class Launch>
void trace(const Share& share, const std::atomic<bool>* cancel, const std::function<void(std::uint32_t)>& done,
           const Launch& launch) {
  std::uint32_t turn = 1;
  for (std::uint32_t first = share.first; first < share.last;) {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return;
    const std::uint32_t last = std::min(share.last, first + std::min(turn, share.last - first));
    const auto start = Clock::now();
    launch(first, last);
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "rendering");
    if (seconds_since(start) < kLaunchSeconds / 2) turn = std::min(2 * turn, 1U << 16U);
    done(last - first);
    first = last;
  }
}

class CudaBackend : public Backend {
 public:
  explicit CudaBackend(const CudaOptions& options) : options_(options) {
    for (const int device : options_.devices) {
      use_device(device);
      // What a step of a series gives back serves the next one.
      cudaMemPool_t pool = nullptr;
      std::uint64_t keep = ~std::uint64_t{0};
      check_cuda(cudaDeviceGetDefaultMemPool(&pool, device), "asking for the device's memory pool");
      check_cuda(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &keep), "keeping device memory");
    }
  }

  std::string_view name() const override { return "cuda"; }

  std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile> file, std::int64_t cell,
                                     std::unique_ptr<LoadedVolume> reuse) override {
    const NvdbGrid& grid = file->grid();
    const std::int64_t edge = cell == 0 ? kDeviceMacrocell : cell;
    use_device(options_.devices.front());
    DeviceBuffer buffer;
    if (auto* last = static_cast<CudaVolume*>(reuse.get()); last != nullptr && !last->dense()) {
      buffer = std::move(last->grid(0)).take_bytes().take_buffer();
    }
    reuse.reset();
    // The file's macrocells are merged while the grid is on its way.
    std::future<MacrocellGrid> merged;
    if (has_macrocells(grid)) {
      merged = std::async(std::launch::async, [&grid, edge] { return MacrocellGrid(grid, edge); });
    }
    std::string note;
    LoadOptions how = options_.load;
    if (!how.zero_copy) note = reason_for_zero_copy(grid, buffer.capacity());
    how.zero_copy = how.zero_copy || !note.empty();
    if (how.zero_copy && options_.devices.size() > 1) {
      throw Error(ErrorKind::usage,
                  cat(note.empty() ? "a grid in host memory" : note, "; several devices cannot share it, use one"));
    }
    DeviceGrid loaded = load_grid(*file, std::move(buffer), how, cudaStreamPerThread);
    const LoadReport& report = loaded.report();
    if (!report.note.empty()) note += cat(note.empty() ? "" : "; ", report.note);
    LoadSummary summary{cat(load_path_name(report.path), report.zero_copy ? ", zero-copy" : ""), report.bytes,
                        report.seconds, note};

    const NodeLattice lattice = make_lattice(grid.index_bbox(), edge);
    std::vector<MinMax> bounds;  // none: the first device gathers them
    if (merged.valid()) bounds = merged.get().bounds();
    std::vector<std::unique_ptr<DeviceVolume>> grids;
    for (const int device : options_.devices) {
      use_device(device);
      GridBytes bytes = grids.empty() ? GridBytes(std::move(loaded))
                                      : GridBytes(grids.front()->bytes(), options_.devices.front(), device);
      grids.push_back(std::make_unique<DeviceVolume>(grid, std::move(bytes), lattice, bounds));
      bounds = grids.front()->host_cells();
    }
    MacrocellGrid cells(lattice, std::move(bounds));
    return std::make_unique<CudaVolume>(std::move(file), std::move(grids), std::move(cells), std::move(summary));
  }

  std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume> volume, std::int64_t cell) override {
    MacrocellGrid cells = macrocells_of(*volume, cell == 0 ? kDeviceMacrocell : cell);
    const auto start = Clock::now();
    std::vector<std::unique_ptr<DenseTexture>> textures;
    for (const int device : options_.devices) {
      use_device(device);
      textures.push_back(std::make_unique<DenseTexture>(volume->view(), cells.bounds()));
    }
    const VolumeInfo info{volume->frame(), volume->range(), volume->background()};
    return std::make_unique<CudaVolume>(info, std::move(textures), std::move(cells),
                                        LoadSummary{"texture", volume->bytes(), seconds_since(start), ""});
  }

  Picture render(LoadedVolume& volume, const Scene& scene, const RenderOptions& options,
                 const SampleOptions& sampling) override {
    auto& loaded = static_cast<CudaVolume&>(volume);
    const RenderSetup setup(loaded.info(), loaded.cells(), scene, options);
    const auto start = Clock::now();
    std::mutex reporting;
    std::uint64_t samples_done = 0;
    const std::uint64_t pixels = static_cast<std::uint64_t>(options.width) * static_cast<std::uint64_t>(options.height);
    const auto done = [&](std::uint32_t samples) {
      const std::lock_guard lock(reporting);
      samples_done += samples;
      if (sampling.progress) sampling.progress(samples_done * pixels);
    };

    // Device i takes the i-th of as many stretches of samples.
    const std::size_t count = options_.devices.size();
    std::vector<std::future<std::vector<Float3>>> shares;
    for (std::size_t i = 0; i < count; ++i) {
      const auto part = [&](std::size_t k) {
        return static_cast<std::uint32_t>(static_cast<std::uint64_t>(sampling.samples) * k / count);
      };
      const Share share{options_.devices[i], part(i), part(i + 1)};
      shares.push_back(std::async(std::launch::async, [&, i, share] {
        return render_share(loaded, i, setup, options, share, sampling.cancel, done);
      }));
    }
    Image image(options.width, options.height);
    for (auto& share : shares) {
      const std::vector<Float3> sums = share.get();
      for (std::size_t p = 0; p < sums.size(); ++p) image.pixels[p] += sums[p];
    }
    if (sampling.cancel != nullptr && sampling.cancel->load(std::memory_order_relaxed)) {
      throw Error(ErrorKind::interrupted, "interrupted; no image was written");
    }
    const float scale = 1.0F / static_cast<float>(std::max(sampling.samples, 1U));
    for (Float3& pixel : image.pixels) pixel = pixel * scale;
    return {std::move(image), setup.tone(), seconds_since(start)};
  }

 private:
  std::vector<Float3> render_share(CudaVolume& volume, std::size_t i, const RenderSetup& setup,
                                   const RenderOptions& options, const Share& share, const std::atomic<bool>* cancel,
                                   const std::function<void(std::uint32_t)>& done) const {
    use_device(share.device);
    DeviceMacrocells& cells = volume.dense() ? volume.texture(i).cells : volume.grid(i).cells();
    const DeviceTransfer transfer(setup.transfer_function());
    cells.update(transfer, cudaStreamPerThread);
    std::optional<DeviceEnvironment> environment;
    if (const EnvironmentView& host = setup.environment(); host.present()) environment.emplace(host);
    DeviceArray<Float3> sums(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
    check_cuda(cudaMemsetAsync(sums.data(), 0, sums.bytes(), cudaStreamPerThread), "clearing the picture");

    const auto run = [&](const auto& sampler) {
      auto task = setup.bare_task(sampler);
      task.medium.transfer = transfer.bounds().transfer;
      task.medium.cell_opacity = cells.majorants();
      task.medium.cell_values = cells.bounds();
      if (environment) task.lighting.environment = environment->view();
      trace(share, cancel, done, [&](std::uint32_t first, std::uint32_t last) {
        launch_render(task, first, last, sums.data(), cudaStreamPerThread);
      });
    };
    if (volume.dense()) {
      run(TextureSampler{volume.texture(i).texture.object(), options.filter == Filter::nearest});
    } else {
      run_filter(volume.grid(i), options.filter, run);
    }
    return sums.download();
  }

  template <class Run>
  void run_filter(DeviceVolume& volume, Filter filter, const Run& run) const {
    if (filter == Filter::trilinear && options_.atlas) {
      if (const BrickAtlas* atlas = volume.atlas()) {
        run(atlas->sampler());
        return;
      }
    }
    volume.with_table([&]<class Block>(const BlockTable<Block>& table) {
      if (filter == Filter::nearest) {
        run(TableSampler<Block, Filter::nearest>{table});
      } else if (filter == Filter::stochastic) {
        run(TableSampler<Block, Filter::stochastic>{table});
      } else {
        run(TableSampler<Block, Filter::trilinear>{table});
      }
    });
  }

  CudaOptions options_;
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend(const CudaOptions& options) {
  return std::make_unique<CudaBackend>(options);
}

}  // namespace weir
