// How a volume is converted: budget, method, policy, and how much of the machine it may use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "compressor/leaf/encoding.h"
#include "compressor/leaf/fill.h"
#include "compressor/leaf/metric.h"
#include "compressor/select/budget.h"
#include "compressor/select/preview.h"
#include "format/packed/block_coder.h"
#include "format/sidecar/scene.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// A scene and where it came from.
struct SceneFile {
  Scene scene;
  std::string path;
};

/// Whether an interrupted conversion can be continued. automatic: where the volume has a GiB of float32 or more, and
/// the output does not lie on a memory file system.
enum class Resume { automatic, on, off };

/// What becomes of voxels that the source declares to hold no data. automatic: what becomes of NaN, which is an error,
/// the background, or NaN. error: before anything is written. background: it takes their place. keep: what stands for
/// "no data" is data; the source has to be opened so (ValueMapping::keeps_missing).
enum class MissingPolicy { automatic, error, background, keep };

/// What the sidecar certifies besides the error of the values.
enum class Certify { values, gradient };

struct ConversionOptions {
  std::string output;      ///< path of the .nvdb
  bool overwrite = false;  ///< replace an existing output
  Budget budget;
  Encoding encoding = Encoding::float32;  ///< automatic: the better of float32 and fpn at the asked size
  Preview preview = Preview::automatic;   ///< of a packed file
  Metric metric = Metric::sse;            ///< what the budget is spent on
  FillMode fill = FillMode::mean;
  std::int64_t brick = 8;           ///< voxels; granularity of the paper's metrics: 8, 16 or 32
  std::optional<SceneFile> scene;   ///< decides what matters; for Metric::sse
  std::optional<float> background;  ///< found in the data where absent
  bool paper_background = false;    ///< the paper's histogram; one more pass over most types
  NonFinitePolicy non_finite = NonFinitePolicy::error;
  MissingPolicy missing = MissingPolicy::automatic;  ///< not background where non_finite is keep
  Certify certify = Certify::values;                 ///< gradient: source and file are read once more
  std::uint64_t memory = std::uint64_t{512} << 20U;  ///< bytes, the whole process
  std::size_t threads = 0;                       ///< workers, 0: one for each processor, as far as `memory` holds them
  std::size_t processors = 0;                    ///< that there are for it, 0: all of the machine's
  CoderChoice backend = CoderChoice::automatic;  ///< for who makes ConversionControl::coder
  std::string work_dir;                          ///< for spill files; empty: a hidden directory beside the output
  Resume resume = Resume::automatic;
  double save_interval_s = 5;  ///< between two points that it can be continued from; 0: after every block, for tests
  Sidecar::Weir provenance;    ///< recorded as it is
  std::uint64_t source_values = 0;  ///< Sidecar::Source::values, recorded as it is
};

/// Names as on the command line and in the sidecar.
std::string metric_name(Metric metric);
std::string fill_name(FillMode fill);
std::string preview_name(Preview preview);
std::string policy_name(NonFinitePolicy policy);
/// What becomes of missing voxels, as the sidecar's missing.policy: "error", "background", "nan" or "keep".
std::string missing_policy_name(const ConversionOptions& options);

}  // namespace weir
