#include <atomic>
#include <memory>
#include <string>

#include "bindings/c/conversion_options.h"
#include "bindings/c/status.h"
#include "bindings/c/weir.h"
#include "compressor/pushed_volume.h"

/// What outlives a PushedVolume comes before it.
struct weir_push {
  explicit weir_push(const weir_convert_options& given)
      : callbacks(given), control(callbacks.control()), files(weir::make_posix_file_system()) {}

  weir::c::Callbacks callbacks;
  weir::ConversionControl control;
  std::unique_ptr<weir::FileSystem> files;
  weir::ConversionOptions options;
  std::unique_ptr<weir::PushedVolume> volume;
  std::array<std::int64_t, 3> packed{};
  std::atomic<bool> ended{false};  // with success
};

namespace weir::c {
namespace {

weir_push& running(weir_push* push) {
  if (required(push, "push")->ended) throw usage("the push has ended; begin another");
  return *push;
}

}  // namespace
}  // namespace weir::c

using namespace weir;
using namespace weir::c;

weir_status weir_push_begin(const weir_volume* volume, const weir_convert_options* options, const char* output,
                            weir_push** push, weir_error* error) {
  return guarded(error, [&] {
    required(push, "push");
    const DenseArray array = read_volume(volume);
    SourceInfo info = array_info(array);
    const weir_convert_options given = options_or_defaults(options);
    auto made = std::make_unique<weir_push>(given);
    made->options = read_options(given);
    made->options.output = checked_output(output);
    made->packed = packed_stride(array.extent, array.type);
    made->volume = std::make_unique<PushedVolume>(std::move(info), made->options, made->control, *made->files);
    *push = made.release();
  });
}

weir_status weir_push_slab(weir_push* push, int64_t z0, int64_t nz, const void* data, const int64_t stride[3],
                           weir_error* error) {
  return guarded(error, [&] {
    weir_push& p = running(push);
    required(data, "data");
    p.volume->slab(z0, nz, data, stride == nullptr ? p.packed : std::array{stride[0], stride[1], stride[2]});
  });
}

weir_status weir_push_end(weir_push* push, weir_error* error) {
  return guarded(error, [&] {
    weir_push& p = running(push);
    p.volume->end();
    p.ended = true;
  });
}

void weir_push_free(weir_push* push) { delete push; }
