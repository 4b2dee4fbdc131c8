// weir_bench_frames SOURCE.raw X,Y,Z FILE.nvdb...: measures frames a second of path tracing with multiple scattering,
// each with one sample a pixel, from a hardware-filtered dense texture of the source (float32) and from files made of
// it, and their ratio in the same run. All variants march through the first file's macrocells, so that only the lookups
// differ.
//   --cells A,B,...   edges of macrocells to try, default 32
//   --size N          pixels along the picture's edge, default 1024
//   --pictures DIR    writes each variant's picture of 64 samples there
//   --scene FILE      default: weir render's
#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_mapping.h"
#include "format/io/file_system.h"
#include "format/nanovdb/nvdb_file.h"
#include "gpu/cuda/render/brick_volume.h"
#include "gpu/cuda/render/device_volume.h"
#include "gpu/cuda/render/render_kernel.h"
#include "gpu/cuda/volume/dense_texture.h"
#include "gpu/cuda/volume/device_memory.h"
#include "gpu/cuda/volume/device_samplers.h"
#include "gpu/image/image_output.h"
#include "gpu/render/render_setup.h"

namespace weir {
namespace {

constexpr float kLeastMilliseconds = 700;  // least duration of a measurement
constexpr std::uint32_t kPictureSamples = 64;

struct Options {
  std::string source;
  Int3 extent;
  std::vector<std::string> files;
  std::vector<std::int64_t> cells{32};
  std::int32_t size = 1024;
  std::string pictures;
  std::string scene;
};

std::vector<std::int64_t> numbers(const std::string& text) {
  std::vector<std::int64_t> result;
  for (const std::string& part : split(text, ',')) result.push_back(parse_int(part).value());
  return result;
}

Options parse(int argc, char** argv) {
  Options options;
  std::vector<std::string> rest;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto value = [&]() -> std::string {
      if (++i == argc) throw Error(ErrorKind::usage, cat(argument, " needs a value"));
      return argv[i];
    };
    if (argument == "--cells") {
      options.cells = numbers(value());
    } else if (argument == "--size") {
      options.size = static_cast<std::int32_t>(numbers(value()).at(0));
    } else if (argument == "--pictures") {
      options.pictures = value();
    } else if (argument == "--scene") {
      options.scene = value();
    } else {
      rest.push_back(argument);
    }
  }
  if (rest.size() < 3) throw Error(ErrorKind::usage, "usage: weir_bench_frames SOURCE.raw X,Y,Z FILE.nvdb...");
  options.source = rest[0];
  const std::vector<std::int64_t> e = numbers(rest[1]);
  options.extent = {static_cast<std::int32_t>(e.at(0)), static_cast<std::int32_t>(e.at(1)),
                    static_cast<std::int32_t>(e.at(2))};
  options.files.assign(rest.begin() + 2, rest.end());
  return options;
}

class Event {
 public:
  Event() { check_cuda(cudaEventCreate(&event_), "making an event"); }
  ~Event() { cudaEventDestroy(event_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  void record() { check_cuda(cudaEventRecord(event_, cudaStreamPerThread), "recording an event"); }
  float milliseconds_since(const Event& begin) {
    check_cuda(cudaEventSynchronize(event_), "rendering");
    float result = 0;
    check_cuda(cudaEventElapsedTime(&result, begin.event_, event_), "timing");
    return result;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

/// Returns the milliseconds of one call of work(i). Repeats the calls until they take long enough, after three calls
/// that do not count.
template <class Work>
double time_of(const Work& work) {
  std::uint32_t call = 0;
  for (int i = 0; i < 3; ++i) work(call++);
  for (int count = 4;; count *= 4) {
    Event begin;
    Event end;
    begin.record();
    for (int i = 0; i < count; ++i) work(call++);
    end.record();
    const float total = end.milliseconds_since(begin);
    if (total >= kLeastMilliseconds || count > 1 << 20) return static_cast<double>(total) / count;
  }
}

Texture dense_texture(const Options& options) {
  const FileMapping file(options.source, ".raw");
  const auto plane = static_cast<std::size_t>(options.extent.x) * static_cast<std::size_t>(options.extent.y);
  if (file.bytes().size() != plane * static_cast<std::size_t>(options.extent.z) * sizeof(float)) {
    throw Error(ErrorKind::input, cat(options.source, ": is not a float32 volume of the extent given"));
  }
  return make_texture({reinterpret_cast<const float*>(file.bytes().data()), options.extent});
}

class Bench {
 public:
  Bench(const Options& options, const NvdbFile& file)
      : options_(options), scene_(options.scene.empty() ? Scene{} : load_scene(options.scene)), grid_(file.grid()) {
    scene_.mode = RenderMode::path;
  }

  void use_cells(std::int64_t edge) {
    edge_ = edge;
    cells_.emplace(grid_, edge);
    device_cells_.emplace(cells_->bounds());
    RenderOptions render;
    render.width = render.height = options_.size;
    setup_ = std::make_unique<RenderSetup>(volume_info(grid_, *cells_), *cells_, scene_, render);
    transfer_.emplace(setup_->transfer_function());
    device_cells_->update(*transfer_, cudaStreamPerThread);
    dense_fps_ = 0;
    first_ = Image();
  }

  /// Runs a variant. The others are compared with the first variant after use_cells().
  template <class Volume>
  void run(const std::string& name, const Volume& volume, std::uint64_t bytes) {
    RenderTask<Volume> task = setup_->bare_task(volume);
    task.medium.transfer = transfer_->bounds().transfer;
    task.medium.cell_opacity = device_cells_->majorants();
    task.medium.cell_values = device_cells_->bounds();
    const DeviceArray<Float3> sums(static_cast<std::size_t>(options_.size) * static_cast<std::size_t>(options_.size));
    check_cuda(cudaMemsetAsync(sums.data(), 0, sums.bytes(), cudaStreamPerThread), "clearing");
    const double frame_ms =
        time_of([&](std::uint32_t i) { launch_render(task, i, i + 1, sums.data(), cudaStreamPerThread); });
    const double fps = 1000 / frame_ms;
    if (dense_fps_ == 0) dense_fps_ = fps;
    const double error = compare(name, task, sums);
    std::printf("%-28s %5lld %9.3f %9.1f %7.3f %9.1f %8.2f\n", name.c_str(), static_cast<long long>(edge_), frame_ms,
                fps, fps / dense_fps_, error, static_cast<double>(bytes) / 1e9);
    std::fflush(stdout);
  }

  void time_transfer_change() {
    const double ms = time_of([&](std::uint32_t) {
      transfer_->replace(setup_->transfer_function());
      device_cells_->update(*transfer_, cudaStreamPerThread);
    });
    std::printf("%-28s %5lld %9.3f ms for %zu cells\n", "transfer function change", static_cast<long long>(edge_), ms,
                device_cells_->size());
  }

 private:
  // Returns the root mean square difference of the picture from the first variant's, in thousandths of white.
  template <class Volume>
  double compare(const std::string& name, const RenderTask<Volume>& task, const DeviceArray<Float3>& sums) {
    check_cuda(cudaMemsetAsync(sums.data(), 0, sums.bytes(), cudaStreamPerThread), "clearing");
    launch_render(task, 0, kPictureSamples, sums.data(), cudaStreamPerThread);
    Image image(options_.size, options_.size);
    image.pixels = sums.download();
    for (Float3& pixel : image.pixels) pixel = pixel * (1.0F / kPictureSamples);
    if (!options_.pictures.empty()) {
      const auto files = make_posix_file_system();
      std::string file = cat(name, "_", edge_, ".png");
      std::replace(file.begin(), file.end(), ' ', '_');
      ImageFile(*files, cat(options_.pictures, "/", file), true).commit(image, setup_->tone());
    }
    if (first_.pixels.empty()) first_ = image;
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const Float3 d = image.pixels[i] - first_.pixels[i];
      sum += static_cast<double>(dot(d, d));
    }
    return 1000 * std::sqrt(sum / (3 * static_cast<double>(image.pixels.size())));
  }

  const Options& options_;
  Scene scene_;
  const NvdbGrid& grid_;
  std::int64_t edge_ = 0;
  std::optional<MacrocellGrid> cells_;
  std::optional<DeviceMacrocells> device_cells_;
  std::unique_ptr<RenderSetup> setup_;
  std::optional<DeviceTransfer> transfer_;
  double dense_fps_ = 0;
  Image first_;
};

void run_bricks(Bench& bench, const std::string& name, BrickCache& bricks) {
  bench.run(name + " trilinear bricks", bricks.sampler<Filter::trilinear>(), bricks.bytes());
  bench.run(name + " stochastic bricks", bricks.sampler<Filter::stochastic>(), bricks.bytes());
}

void run_file(Bench& bench, const std::string& name, DeviceVolume& volume) {
  const std::uint64_t bytes = volume.bytes().bytes();
  volume.with_table([&]<class Block>(const BlockTable<Block>& table) {
    bench.run(name + " stochastic", TableSampler<Block, Filter::stochastic>{table}, bytes);
    bench.run(name + " trilinear table", TableSampler<Block, Filter::trilinear>{table}, bytes);
  });
  if (BrickCache* atlas = volume.atlas()) {
    run_bricks(bench, name, *atlas);
  } else {
    std::printf("%s\n", volume.atlas_refusal().c_str());
  }
}

void run(const Options& options) {
  use_device(0);
  std::vector<std::unique_ptr<NvdbFile>> files;
  std::vector<std::unique_ptr<DeviceVolume>> volumes;  // null if the file is packed
  std::vector<std::unique_ptr<BrickVolume>> packed;    // null if the file is not packed
  for (const std::string& path : options.files) {
    files.push_back(std::make_unique<NvdbFile>(path));
    const NvdbGrid& grid = files.back()->grid();
    LoadOptions how;
    how.packed = true;
    DeviceGrid loaded = load_grid(*files.back(), {}, how);
    const LoadReport report = loaded.report();
    const MacrocellGrid cells(grid, 32);
    if (grid.packed() != nullptr) {
      volumes.push_back(nullptr);
      packed.push_back(std::make_unique<BrickVolume>(grid, GridBytes(std::move(loaded)), cells.bounds(),
                                                     BrickBudget{free_device_bytes(0) - kSpareDeviceBytes}));
    } else {
      packed.push_back(nullptr);
      volumes.push_back(std::make_unique<DeviceVolume>(grid, GridBytes(std::move(loaded)),
                                                       make_lattice(grid.index_bbox(), 32), cells.bounds()));
    }
    std::printf("%s: %s, %.2f GB, %s, %.1f GB/s\n", path.c_str(), std::string(grid_type_name(grid.type())).c_str(),
                static_cast<double>(report.bytes) / 1e9, std::string(load_path_name(report.path)).c_str(),
                report.gb_per_s());
  }
  const Texture dense = dense_texture(options);
  std::printf("%d x %d pixels, %d x %d x %d voxels\n", options.size, options.size, options.extent.x, options.extent.y,
              options.extent.z);
  std::printf("%-28s %5s %9s %9s %7s %9s %8s\n", "variant", "cell", "ms", "fps", "ratio", "rms/1000", "GB");
  Bench bench(options, *files.front());
  for (const std::int64_t edge : options.cells) {
    bench.use_cells(edge);
    bench.run("dense texture", TextureSampler{dense.object()}, dense.bytes());
    for (std::size_t i = 0; i < volumes.size(); ++i) {
      if (packed[i]) {
        run_bricks(bench, "packed", packed[i]->cache());
      } else {
        run_file(bench, std::string(grid_type_name(files[i]->grid().type())), *volumes[i]);
      }
    }
    bench.time_transfer_change();
  }
}

}  // namespace
}  // namespace weir

int main(int argc, char** argv) {
  try {
    weir::run(weir::parse(argc, argv));
  } catch (const weir::Error& error) {
    std::fprintf(stderr, "weir_bench_frames: %s\n", error.what());
    return error.exit_code();
  }
}
