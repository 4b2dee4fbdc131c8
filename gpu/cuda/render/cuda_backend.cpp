#include "gpu/cuda/render/cuda_backend.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <mutex>
#include <utility>

#include "format/base/error.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "gpu/cuda/render/cuda_volume.h"
#include "gpu/cuda/render/device_room.h"
#include "gpu/cuda/render/refused_memory.h"
#include "gpu/cuda/render/render_kernel.h"
#include "gpu/cuda/render/trace_paged.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/volume/device_environment.h"
#include "gpu/cuda/volume/device_memory.h"
#include "gpu/cuda/volume/device_samplers.h"
#include "gpu/volume/levelled_volume.h"

namespace weir {

namespace {

using Clock = std::chrono::steady_clock;

/// One device's part of a picture.
struct Share {
  int device = 0;
  std::uint32_t first = 0;  ///< samples [first, last)
  std::uint32_t last = 0;
};

/// The result of a share.
struct ShareDone {
  std::vector<Float3> sums;
  std::uint64_t missed = 0;  ///< as in Picture
  CacheCounts cache;         ///< as in Picture
  bool drawn = false;        ///< the share had samples
  std::string memory_note;   ///< as in Picture
};

/// Draws the samples in turns that grow until a turn takes kLaunchSeconds. `launch` starts samples [first, last) on
/// the default stream.
template <class Launch>
void trace(const Share& share, std::uint64_t pixels, const std::atomic<bool>* cancel,
           const std::function<void(std::uint64_t)>& done, const Launch& launch) {
  std::uint32_t turn = 1;
  for (std::uint32_t first = share.first; first < share.last;) {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return;
    const std::uint32_t last = std::min(share.last, first + std::min(turn, share.last - first));
    const auto start = Clock::now();
    launch(first, last);
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "rendering");
    if (seconds_since(start) < kLaunchSeconds / 2) turn = std::min(2 * turn, 1U << 16U);
    done(pixels * (last - first));
    first = last;
  }
}

class CudaBackend : public Backend {
 public:
  explicit CudaBackend(const CudaOptions& options) : options_(options) {
    for (const int device : options_.devices) {
      use_device(device);
      kept_.emplace_back(device);
    }
  }

  std::string_view name() const override { return "cuda"; }

  std::unique_ptr<LoadedVolume> load(std::shared_ptr<const NvdbFile> file, std::int64_t cell,
                                     std::unique_ptr<LoadedVolume> reuse) override {
    const std::string path = file->path();
    try {
      return load_file(std::move(file), cell, std::move(reuse));
    } catch (const DeviceFull& refused) {
      throw refused_error(path, refused);
    }
  }

  std::unique_ptr<LoadedVolume> load_dense(std::shared_ptr<const DenseVolume> volume, std::int64_t cell) override {
    if (options_.levels) {
      throw Error(ErrorKind::usage, compose("a dense volume has no levels of detail on a device; give ",
                                            option("lod", "off"), " or ", option("backend", "cpu")));
    }
    MacrocellGrid cells = macrocells_of(*volume, cell == 0 ? kDeviceMacrocell : cell);
    const auto start = Clock::now();
    std::vector<std::unique_ptr<DenseTexture>> textures;
    for (const int device : options_.devices) {
      use_device(device);
      try {
        textures.push_back(std::make_unique<DenseTexture>(volume->view(), cells.bounds()));
      } catch (const DeviceFull& refused) {
        throw refused_error("a dense volume", refused);
      }
    }
    const VolumeInfo info{volume->frame(), volume->range(), volume->background()};
    return std::make_unique<CudaVolume>(info, std::move(textures), std::move(cells),
                                        LoadSummary{"texture", volume->bytes(), seconds_since(start), ""});
  }

  Picture render(LoadedVolume& volume, const Scene& scene, const RenderOptions& options,
                 const SampleOptions& sampling) override {
    try {
      return draw(static_cast<CudaVolume&>(volume), scene, options, sampling);
    } catch (const DeviceFull& refused) {
      throw refused_error(cat("a picture of ", options.width, " x ", options.height, " pixels"), refused,
                          "make it smaller");
    }
  }

 private:
  std::unique_ptr<LoadedVolume> load_file(std::shared_ptr<const NvdbFile> file, std::int64_t cell,
                                          std::unique_ptr<LoadedVolume> reuse) {
    const NvdbGrid& grid = file->grid();
    const std::int64_t edge = cell == 0 ? kDeviceMacrocell : cell;
    use_device(options_.devices.front());
    DeviceBuffer buffer;
    if (auto* last = static_cast<CudaVolume*>(reuse.get()); last != nullptr && !last->dense()) {
      buffer = last->in_bricks() ? std::move(last->bricks(0)).take_bytes().take_buffer()
                                 : std::move(last->grid(0)).take_bytes().take_buffer();
    }
    reuse.reset();
    // A buffer that a larger step has left would take memory from this step's cache.
    buffer.shrink_to(grid.data_bytes());
    // The file's macrocells are merged while the grid is being copied.
    std::future<MacrocellGrid> merged;
    if (has_macrocells(grid)) {
      merged = std::async(std::launch::async, [&grid, edge] { return MacrocellGrid(grid, edge); });
    }
    std::string note;
    LoadOptions how = options_.load;
    how.packed = true;
    const DeviceRoom room = room_for(grid, options_, buffer.capacity());
    if (!how.zero_copy) note = reason_for_zero_copy(grid, room);
    DeviceGrid loaded = load_bytes(*file, std::move(buffer), how, note);
    const bool in_bricks =
        grid.packed() != nullptr || options_.levels || (!note.empty() && worth_bricks(grid, room.bytes));
    const LoadReport& report = loaded.report();
    if (!report.note.empty()) note += cat(note.empty() ? "" : "; ", report.note);
    LoadSummary summary{cat(load_path_name(report.path), report.zero_copy ? ", zero-copy" : ""), report.bytes,
                        report.seconds, note};

    if (in_bricks) {
      MacrocellGrid cells = merged.valid() ? merged.get() : MacrocellGrid(grid, edge);
      std::vector<std::unique_ptr<BrickVolume>> bricks;
      for (const int device : options_.devices) {
        use_device(device);
        GridBytes bytes = bricks.empty() ? GridBytes(std::move(loaded))
                                         : GridBytes(bricks.front()->bytes(), options_.devices.front(), device);
        bricks.push_back(std::make_unique<BrickVolume>(grid, std::move(bytes), cells.bounds(), room.budget()));
      }
      BrickCache& cache = bricks.front()->cache();
      summary.note +=
          cat(summary.note.empty() ? "" : "; ", cache.paged() ? "a cache of " : "all of ", cache.bricks(), " bricks, ",
              format_bytes(cache.bytes()), cache.paged() ? "" : ", ", cache.paged() ? "" : cache.texels_note());
      return std::make_unique<CudaVolume>(std::move(file), std::move(bricks), std::move(cells), std::move(summary));
    }
    const NodeLattice lattice = make_lattice(grid.index_bbox(), edge);
    std::vector<MinMax> bounds;  // if empty, the first device gathers them
    if (merged.valid()) bounds = merged.get().bounds();
    std::vector<std::unique_ptr<DeviceVolume>> grids;
    for (const int device : options_.devices) {
      use_device(device);
      GridBytes bytes = grids.empty() ? GridBytes(std::move(loaded))
                                      : GridBytes(grids.front()->bytes(), options_.devices.front(), device);
      grids.push_back(std::make_unique<DeviceVolume>(grid, std::move(bytes), lattice, bounds,
                                                     room.limited ? room.bytes : ~std::uint64_t{0}));
      bounds = grids.front()->host_cells();
    }
    MacrocellGrid cells(lattice, std::move(bounds));
    return std::make_unique<CudaVolume>(std::move(file), std::move(grids), std::move(cells), std::move(summary));
  }

  // Loads into host memory if `note` gives a reason for this, or if the device refuses to hold the grid.
  DeviceGrid load_bytes(const NvdbFile& file, DeviceBuffer buffer, LoadOptions how, std::string& note) const {
    const bool several = options_.devices.size() > 1;
    if (!how.zero_copy && note.empty()) {
      try {
        return load_grid(file, std::move(buffer), how, cudaStreamPerThread);
      } catch (const DeviceFull& refused) {
        if (several) throw;
        note = cat(refused.what(), ", so it stays in host memory");
      }
    }
    if (several) {
      throw Error(ErrorKind::usage,
                  cat(note.empty() ? "a grid in host memory" : note, "; several devices cannot share it, use one"));
    }
    how.zero_copy = true;
    if (buffer.capacity() > 0) {
      buffer = DeviceBuffer();
      free_device_bytes(~std::uint64_t{0});
    }
    return load_grid(file, std::move(buffer), how, cudaStreamPerThread);
  }

  Picture draw(CudaVolume& loaded, const Scene& scene, const RenderOptions& options, const SampleOptions& sampling) {
    const RenderSetup setup(loaded.info(), loaded.cells(), scene, options);
    const auto start = Clock::now();
    std::string note;
    const int finest_level = levels_for(loaded, setup, note);
    std::mutex reporting;
    std::uint64_t samples_done = 0;
    const auto done = [&](std::uint64_t samples) {
      const std::lock_guard lock(reporting);
      samples_done += samples;
      if (sampling.progress) sampling.progress(samples_done);
    };

    // The samples are cut into as many stretches as there are devices. Device i takes the i-th.
    const std::size_t count = options_.devices.size();
    std::vector<std::future<ShareDone>> shares;
    for (std::size_t i = 0; i < count; ++i) {
      const auto part = [&](std::size_t k) {
        return static_cast<std::uint32_t>(static_cast<std::uint64_t>(sampling.samples) * k / count);
      };
      const Share share{options_.devices[i], part(i), part(i + 1)};
      shares.push_back(std::async(std::launch::async, [&, i, share] {
        return render_share(loaded, i, setup, finest_level, options, share, sampling, done);
      }));
    }
    Image image(options.width, options.height);
    std::uint64_t missed = 0;
    CacheCounts counts;
    std::string memory_note;
    for (auto& share : shares) {
      const ShareDone part = share.get();
      counts += part.cache;
      if (memory_note.empty()) memory_note = part.memory_note;
      for (std::size_t p = 0; p < part.sums.size(); ++p) image.pixels[p] += part.sums[p];
      if (part.drawn) missed = part.missed;  // the last share has the last sample
    }
    if (sampling.cancel != nullptr && sampling.cancel->load(std::memory_order_relaxed)) {
      throw Error(ErrorKind::interrupted, "interrupted; no image was written");
    }
    const float scale = 1.0F / static_cast<float>(std::max(sampling.samples, 1U));
    for (Float3& pixel : image.pixels) pixel = pixel * scale;
    return {std::move(image), setup.tone(), seconds_since(start), counts, missed, finest_level, note, memory_note};
  }

  // Returns the finest level of detail that a picture is made with; 0: voxels alone.
  static int levels_for(const CudaVolume& volume, const RenderSetup& setup, std::string& note) {
    if (!setup.levels()) return 0;
    if (!volume.in_bricks()) {
      throw Error(ErrorKind::usage,
                  compose("a volume without bricks has no levels of detail on a device; render it with ",
                          option("lod", "off"), " or ", option("backend", "cpu")));
    }
    const int finest = volume.bricks(0).finest_level(setup.levels()->finest);
    note = levels_note(finest, setup.levels()->finest, setup.levels()->coarsest);
    return levels_are_of_use(finest, setup.levels()->coarsest) ? finest : 0;
  }

  // Draws the share again from its first sample as long as the volume can give memory back for what was refused.
  ShareDone render_share(CudaVolume& volume, std::size_t i, const RenderSetup& setup, int finest_level,
                         const RenderOptions& options, const Share& share, const SampleOptions& sampling,
                         const std::function<void(std::uint64_t)>& done) const {
    use_device(share.device);
    std::uint64_t drawn = 0;     // samples
    std::uint64_t reported = 0;  // samples reported so far
    const auto report = [&](std::uint64_t samples) {
      drawn += samples;
      if (drawn > reported) done(drawn - std::exchange(reported, drawn));
    };
    for (;;) {
      try {
        if (volume.in_bricks()) volume.bricks(i).cache().restore();
        return draw_share(volume, i, setup, finest_level, options, share, sampling, report);
      } catch (const DeviceFull& refused) {
        if (volume.dense()) throw;
        if (!(volume.in_bricks() ? make_room(volume.bricks(i), refused) : make_room(volume.grid(i), refused))) throw;
        drawn = 0;
      }
    }
  }

  ShareDone draw_share(CudaVolume& volume, std::size_t i, const RenderSetup& setup, int finest_level,
                       const RenderOptions& options, const Share& share, const SampleOptions& sampling,
                       const std::function<void(std::uint64_t)>& done) const {
    std::optional<DeviceMacrocells> levelled;
    if (finest_level > 0)
      levelled.emplace(volume.bricks(i).levelled_cells(finest_level, volume.cells().lattice(), setup.levels()->choice,
                                                       sampling.draft));
    DeviceMacrocells& cells = levelled             ? *levelled
                              : volume.dense()     ? volume.texture(i).cells
                              : volume.in_bricks() ? volume.bricks(i).cells()
                                                   : volume.grid(i).cells();
    const DeviceTransfer transfer(setup.transfer_function());
    cells.update(transfer, cudaStreamPerThread);
    std::optional<DeviceEnvironment> environment;
    if (const EnvironmentView& host = setup.environment(); host.present()) environment.emplace(host);
    DeviceArray<Float3> sums(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
    check_cuda(cudaMemsetAsync(sums.data(), 0, sums.bytes(), cudaStreamPerThread), "clearing the picture");

    const auto task_of = [&](const auto& sampler) {
      auto task = setup.bare_task(sampler);
      task.medium.transfer = transfer.bounds().transfer;
      task.medium.cell_opacity = cells.majorants();
      task.medium.cell_values = cells.bounds();
      if (environment) task.lighting.environment = environment->view();
      return task;
    };
    std::uint64_t missed = 0;
    CacheCounts counts;
    const auto run = [&](const auto& sampler) {
      const auto task = task_of(sampler);
      trace(share, sums.size(), sampling.cancel, done, [&](std::uint32_t first, std::uint32_t last) {
        launch_render(task, first, last, sums.data(), cudaStreamPerThread);
      });
    };
    if (volume.dense()) {
      run(TextureSampler{volume.texture(i).texture.object(), options.filter == Filter::nearest});
    } else if (volume.in_bricks()) {
      BrickCache& cache = volume.bricks(i).cache();
      // `seen(sampler)` returns the volume that is rendered.
      const auto run_bricks = [&](const auto& seen) {
        with_filter(options.filter, [&]<Filter kFilter>() {
          if (!cache.paged()) return run(seen(cache.sampler<kFilter>()));
          const auto task_of_seen = [&](const auto& sampler) { return task_of(seen(sampler)); };
          const auto draw = [&]<class Sampler>(const Sampler&) {
            if (sampling.draft) {
              const DraftReport draft = trace_draft<Sampler>(cache, task_of_seen, share.first, share.last, sums, done);
              missed = draft.missed;
              counts.evicted = draft.evicted;
            } else {
              const PagedReport report =
                  trace_paged<Sampler>(cache, task_of_seen, share.first, share.last, sums, sampling.cancel, done);
              counts = {.decoded = report.decoded, .evicted = report.evicted};
            }
          };
          if (setup.mode() == RenderMode::path) {
            cache.with_paged_sampler<kFilter, Noting::called>(draw);
          } else {
            cache.with_paged_sampler<kFilter, Noting::inlined>(draw);
          }
        });
      };
      if (finest_level == 0) {
        run_bricks([](const auto& sampler) { return sampler; });
      } else {
        const LevelsView<TextureSampler> levels = volume.bricks(i).levels(finest_level).view();
        run_bricks([&]<class Fine>(const Fine& fine) {
          return LevelledVolume<Fine, TextureSampler>{fine, levels, setup.levels()->choice};
        });
      }
    } else {
      run_filter(volume.grid(i), options.filter, run);
    }
    return {sums.download(), missed, counts, share.first < share.last, note_of(volume, i)};
  }

  static std::string note_of(CudaVolume& volume, std::size_t i) {
    if (volume.dense()) return "";
    return volume.in_bricks() ? memory_note(volume.bricks(i).cache()) : memory_note(volume.grid(i));
  }

  // Calls use<Filter>() with the filter as a compile-time constant.
  template <class Use>
  static void with_filter(Filter filter, const Use& use) {
    if (filter == Filter::nearest) return use.template operator()<Filter::nearest>();
    if (filter == Filter::stochastic) return use.template operator()<Filter::stochastic>();
    return use.template operator()<Filter::trilinear>();
  }

  template <class Run>
  void run_filter(DeviceVolume& volume, Filter filter, const Run& run) const {
    if (filter == Filter::trilinear && options_.atlas) {
      if (BrickCache* atlas = volume.atlas()) {
        run(atlas->sampler<Filter::trilinear>());
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
  std::deque<KeptMemory> kept_;  // lets a step of a series reuse what the step before gives back
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend(const CudaOptions& options) {
  return std::make_unique<CudaBackend>(options);
}

}  // namespace weir
