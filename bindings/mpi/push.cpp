#include <array>
#include <memory>
#include <optional>
#include <string>

#include "bindings/c/conversion_options.h"
#include "bindings/c/status.h"
#include "bindings/mpi/agreement.h"
#include "bindings/mpi/mpi_team.h"
#include "bindings/mpi/pushed_boxes.h"
#include "bindings/mpi/weir_mpi.h"
#include "compressor/conversion_memory.h"
#include "format/base/text.h"

/// A member that must outlive `boxes` comes before it.
struct weir_mpi_push {
  explicit weir_mpi_push(MPI_Comm communicator) : team(communicator) {}

  weir::MpiTeam team;
  std::optional<weir::c::Callbacks> callbacks;
  weir::ConversionControl control;
  std::array<std::int64_t, 3> extent{};
  weir::ScalarType type{};
  std::unique_ptr<weir::PushedBoxes> boxes;
  bool ended = false;  // ended with success
};

namespace weir::c {
namespace {

weir_mpi_push& running(weir_mpi_push* push) {
  if (required(push, "push")->ended) throw usage("the push has ended; begin another");
  return *push;
}

// Returns three members of `name`, each at least `least` and small enough to be added.
Index3 index_of(const int64_t* values, const char* name, int64_t least) {
  required(values, name);
  for (int i = 0; i < 3; ++i) {
    if (values[i] >= least && values[i] < int64_t{1} << 31U) continue;
    throw usage(cat(name, '[', i, "] is ", values[i], ", it must be ", least, " to 2^31 - 1"));
  }
  return {values[0], values[1], values[2]};
}

}  // namespace
}  // namespace weir::c

using namespace weir;
using namespace weir::c;

weir_status weir_mpi_push_begin(MPI_Comm comm, const weir_volume* volume, const weir_convert_options* options,
                                const char* output, weir_mpi_push** push, weir_error* error) {
  return guarded(error, [&] {
    if (comm == MPI_COMM_NULL) throw usage("comm is MPI_COMM_NULL");
    // A fault of one process is told to all, because the others would wait for it.
    auto made = std::make_unique<weir_mpi_push>(comm);
    SourceInfo info;
    ConversionOptions conversion;
    made->team.run([&] {
      required(push, "push");
      const weir_convert_options given = options_or_defaults(options);
      made->control = made->callbacks.emplace(given).control();
      const DenseArray array = read_volume(volume);
      info = array_info(array);
      made->type = array.type;
      conversion = read_options(given);
      info.mapping.keeps_missing = conversion.missing == MissingPolicy::keep;
      conversion.output = checked_output(output);
      keep_places(conversion);
      if (conversion.backend == CoderChoice::cuda)
        throw usage("backend is WEIR_BACKEND_CUDA, and ranks encode on the CPU");
    });
    require_alike(made->team, info.path, said_by_all(info, conversion));
    conversion.processors = made->team.own_cores();
    // Checked now, because at the end it would be too late: all boxes would have been taken.
    made->team.run([&] { check_memory(conversion, info.domain(), 0); });
    made->boxes = std::make_unique<PushedBoxes>(std::move(info), conversion, made->control, made->team);
    *push = made.release();
  });
}

weir_status weir_mpi_push_begin_fortran(MPI_Fint comm, const weir_volume* volume, const weir_convert_options* options,
                                        const char* output, weir_mpi_push** push, weir_error* error) {
  return weir_mpi_push_begin(MPI_Comm_f2c(comm), volume, options, output, push, error);
}

weir_status weir_mpi_push_box(weir_mpi_push* push, const int64_t lo[3], const int64_t extent[3], const void* data,
                              const int64_t stride[3], weir_error* error) {
  return guarded(error, [&] {
    weir_mpi_push& p = running(push);
    p.callbacks->look_for_cancel();
    const Index3 first = index_of(lo, "lo", 0);
    const Index3 size = index_of(extent, "extent", 1);
    required(data, "data");
    p.boxes->box({first, first + size}, data,
                 stride == nullptr ? packed_stride(size, p.type) : std::array{stride[0], stride[1], stride[2]});
  });
}

weir_status weir_mpi_push_end(weir_mpi_push* push, weir_error* error) {
  return guarded(error, [&] {
    weir_mpi_push& p = running(push);
    p.boxes->end();
    p.ended = true;
  });
}

void weir_mpi_push_free(weir_mpi_push* push) { delete push; }
