#include <memory>
#include <utility>

#include "bindings/c/conversion_options.h"
#include "bindings/c/status.h"
#include "bindings/c/weir.h"
#include "compressor/push/pushed_volume.h"

/// What outlives a PushedVolume comes before it.
struct weir_push {
  explicit weir_push(const weir_convert_options& given) : callbacks(given), files(weir::make_posix_file_system()) {}

  weir::c::Callbacks callbacks;
  std::unique_ptr<weir::FileSystem> files;
  std::unique_ptr<weir::PushedVolume> volume;
};

using namespace weir;
using namespace weir::c;

weir_status weir_push_begin(const weir_volume* volume, const weir_convert_options* options, const char* output,
                            weir_push** push, weir_error* error) {
  return guarded(error, [&] {
    required(push, "push");
    SourceInfo info = array_info(read_volume(volume));
    const weir_convert_options given = options_or_defaults(options);
    auto made = std::make_unique<weir_push>(given);
    ConversionOptions conversion = read_options(given);
    conversion.output = checked_output(output);
    made->volume = std::make_unique<PushedVolume>(std::move(info), conversion, made->callbacks.control(), *made->files);
    *push = made.release();
  });
}

weir_status weir_push_slab(weir_push* push, int64_t z0, int64_t nz, const void* data, const int64_t stride[3],
                           weir_error* error) {
  return guarded(error, [&] {
    PushedVolume& volume = *required(push, "push")->volume;
    if (stride == nullptr) {
      volume.slab(z0, nz, data);
    } else {
      volume.slab(z0, nz, data, {stride[0], stride[1], stride[2]});
    }
  });
}

weir_status weir_push_end(weir_push* push, weir_error* error) {
  return guarded(error, [&] { required(push, "push")->volume->end(); });
}

void weir_push_free(weir_push* push) { delete push; }
