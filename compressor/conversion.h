// One conversion: a volume in, a NanoVDB file of exactly the asked size and its
// sidecar out, under a memory ceiling, all or nothing.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "compressor/leaf/encoding.h"
#include "compressor/leaf/fill.h"
#include "compressor/select/budget.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/team/team.h"
#include "format/base/trace.h"
#include "format/io/file_system.h"
#include "format/sidecar/scene.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

class OutputFiles;
class WorkDirectory;

/// A scene and where it came from.
struct SceneFile {
  Scene scene;
  std::string path;
};

/// Whether an interrupted conversion can be continued. automatic: where the volume has a GiB of float32 or more, and
/// the output does not lie on a memory file system.
enum class Resume { automatic, on, off };

struct ConversionOptions {
  std::string output;      ///< path of the .nvdb
  bool overwrite = false;  ///< replace an existing output
  Budget budget;
  Encoding encoding = Encoding::float32;  ///< automatic: the better of float32 and fpn at the asked size
  Metric metric = Metric::sse;            ///< what the budget is spent on
  FillMode fill = FillMode::mean;
  std::int64_t brick = 8;           ///< voxels; granularity of the paper's metrics: 8, 16 or 32
  std::optional<SceneFile> scene;   ///< decides what matters; for Metric::sse
  std::optional<float> background;  ///< found in the data where absent
  bool paper_background = false;    ///< the paper's histogram; one more pass over most types
  NonFinitePolicy non_finite = NonFinitePolicy::error;
  std::uint64_t memory = std::uint64_t{512} << 20U;  ///< bytes, the whole process
  std::size_t threads = 0;     ///< workers, 0: one for each processor, as far as `memory` holds them
  std::size_t processors = 0;  ///< that there are for it, 0: all of the machine's
  std::string work_dir;        ///< for spill files; empty: a hidden directory beside the output
  Resume resume = Resume::automatic;
  double save_interval_s = 5;  ///< between two points that it can be continued from; 0: after every block, for tests
  Sidecar::Weir provenance;    ///< recorded as it is
};

/// What a caller can watch and stop.
struct ConversionControl {
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string& pass, std::uint64_t total_bytes)> pass_started;  ///< float32 bytes
  std::function<void(std::uint64_t done_bytes)> pass_advanced;
  std::function<void(const std::string& line)> notice;
  std::function<void(std::uint64_t bytes)>
      planned;             ///< of the file, before room is taken for it; again where it is replanned
  Trace* trace = nullptr;  ///< gets the passes, and what each thread reads, surveys, encodes and writes in them
};

/// Converts and returns the sidecar that was written. Throws Error; then what was there before is untouched, and of the
/// output nothing is left but, where it can be continued (journal.h), what the hidden directory beside it holds: the
/// same call goes on from there and ends with the same bytes. Where `team` has other ranks, each calls this with a
/// source of the same volume, the same options and a file system in which they find the files of each other; what is
/// interrupted is lost then, and options.memory and options.threads are those of each process.
Sidecar convert_volume(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                       FileSystem& files, Team& team = no_team());

/// The same into an output whose lock the caller holds, by the work directory beside it; options.memory is what this
/// takes besides what the process holds already, and what is interrupted is lost.
Sidecar convert_into(OutputFiles& output, WorkDirectory& work, VolumeSource& source, const ConversionOptions& options,
                     const ConversionControl& control, Team& team);

/// Names as on the command line and in the sidecar.
std::string metric_name(Metric metric);
std::string fill_name(FillMode fill);
std::string policy_name(NonFinitePolicy policy);

}  // namespace weir
