#include "compressor/forecast/forecast_checks.h"

#include <cerrno>

#include "compressor/forecast/scratch_file_system.h"
#include "compressor/resume.h"
#include "compressor/resume/work_directory.h"
#include "format/base/error.h"
#include "format/io/output_names.h"
#include "format/layout/tree_layout.h"
#include "format/nanovdb/macrocells.h"
#include "format/output/output_files.h"

namespace weir {

OutputPlaces::OutputPlaces(FileSystem& files, const ConversionOptions& options)
    : files_(files), options_(options), directory_(directory_of(options.output)) {
  ScratchFileSystem scratch(files, options.output);
  const OutputFiles output(scratch, options.output, options.overwrite);
  const WorkDirectory work(scratch, options.output, options.work_dir);
  require_lasting_output(options, files.is_memory(directory_));
  spill_directory_ = work.path() == hidden_directory_of(options.output) ? directory_ : work.path();
}

void OutputPlaces::require_room(std::uint64_t file_bytes, std::uint64_t scratch_bytes) const {
  const bool beside = spill_directory_ == directory_;
  require_room_in(directory_, file_bytes + (beside ? scratch_bytes : 0));
  if (!beside) require_room_in(spill_directory_, scratch_bytes);
}

void OutputPlaces::require_room_in(const std::string& directory, std::uint64_t bytes) const {
  const std::uint64_t free = files_.free_bytes(directory);
  if (bytes <= free) return;
  throw Error(ErrorKind::io,
              compose(options_.output, ": takes ", bytes, " bytes of ", directory, ", which has ", free, " free",
                      disk_full_remedy()),
              SystemFailure{ENOSPC, directory});
}

void refuse_sampled_values(const ConversionOptions& options, const Sidecar& sidecar) {
  const Index3& extent = sidecar.source.extent;
  if (options.non_finite == NonFinitePolicy::error && sidecar.nonfinite.count > 0) {
    throw input_error(
        sidecar.source.path,
        compose(sidecar.nonfinite.count, " of the ", volume(extent), " voxels sampled are NaN or infinite; choose ",
                option("nonfinite", "background"), " or ", option("nonfinite", "keep")));
  }
  if (missing_policy_name(options) == "error" && sidecar.missing.count > 0) {
    throw input_error(sidecar.source.path,
                      compose(sidecar.missing.count, " of the ", volume(extent),
                              " voxels sampled hold no data; choose ", option("missing-policy", "background"),
                              " or, to take them for data, ", option("missing-policy", "keep")));
  }
}

void refuse_size(const ConversionOptions& options, std::uint64_t bytes, std::uint64_t least) {
  throw Error(ErrorKind::budget,
              compose(options.output, ": ", bytes, " bytes asked, the smallest tree for this volume takes about ",
                      least, "; ask for ", option("size", least), " or more"));
}

void refuse_hopeless_size(const ConversionOptions& options, const Box& domain, std::uint64_t bytes) {
  NodeCounts counts;
  counts.root_tiles = 1;
  counts.macrocells = static_cast<std::uint64_t>(make_lattice(domain, kMacrocell).size());
  const std::uint64_t least = make_layout(counts).content_end;
  if (bytes >= least) return;
  throw Error(ErrorKind::budget, compose(options.output, ": ", bytes, " bytes asked, a file of this volume takes ",
                                         least, " besides its tree; ask for more with ", option("size")));
}

}  // namespace weir
