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

/// Whether an interrupted conversion can be continued. automatic: yes if the volume has 1 GiB of float32 or more and
/// the output does not lie on a memory file system.
enum class Resume { automatic, on, off };

/// What becomes of voxels that the source declares to hold no data. automatic: the same as NaN, which gives an error,
/// the background, or NaN. error: an error before anything is written. background: the background takes their place.
/// keep: the value that means "no data" counts as data; the source must be opened with ValueMapping::keeps_missing.
enum class MissingPolicy { automatic, error, background, keep };

/// What the sidecar certifies besides the error of the values.
enum class Certify { values, gradient };

struct ConversionOptions {
  std::string output;      ///< path of the .nvdb
  bool overwrite = false;  ///< replace an existing output
  Budget budget;
  Encoding encoding = Encoding::float32;  ///< automatic: the better of float32 and fpn at the asked size
  Preview preview = Preview::automatic;   ///< whether a packed file has one
  Metric metric = Metric::sse;            ///< the error that the budget is spent to reduce
  FillMode fill = FillMode::mean;
  std::int64_t brick = 8;           ///< voxels; granularity of the paper's metrics: 8, 16 or 32
  std::optional<SceneFile> scene;   ///< weights errors by what the scene shows; for Metric::sse
  std::optional<float> background;  ///< if absent, found in the data
  bool paper_background = false;    ///< found by the paper's histogram; one more pass for most types
  NonFinitePolicy non_finite = NonFinitePolicy::error;
  MissingPolicy missing = MissingPolicy::automatic;  ///< not background if non_finite is keep
  Certify certify = Certify::values;                 ///< gradient reads source and file once more
  std::uint64_t memory = std::uint64_t{512} << 20U;  ///< bytes, the whole process
  std::size_t threads = 0;     ///< workers; 0: one per processor, or fewer if `memory` does not hold them
  std::size_t processors = 0;  ///< processors that may be used; 0: all of the machine's
  CoderChoice backend = CoderChoice::automatic;  ///< for the caller, which makes ConversionControl::coder
  std::string work_dir;                          ///< for spill files; empty: a hidden directory beside the output
  Resume resume = Resume::automatic;
  double save_interval_s = 5;  ///< seconds between two saves of a resumable conversion; 0: after every block, for tests
  Sidecar::Weir provenance;    ///< copied to the sidecar
  std::uint64_t source_values = 0;  ///< copied to Sidecar::Source::values
};

/// Return the names that the command line and the sidecar use.
std::string metric_name(Metric metric);
std::string fill_name(FillMode fill);
std::string preview_name(Preview preview);
std::string policy_name(NonFinitePolicy policy);
/// Returns the sidecar's missing.policy, which says what becomes of missing voxels: "error", "background", "nan" or
/// "keep".
std::string missing_policy_name(const ConversionOptions& options);

}  // namespace weir
