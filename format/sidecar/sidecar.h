// The sidecar OUT.nvdb.json: what one conversion read, chose, lost and wrote.
// The struct holds every key of the JSON document under the same name; the
// schema is format/sidecar.schema.json. Plain data, no invariants.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/index.h"

namespace weir {

/// Value of the key `weir_sidecar`. A reader refuses any other.
inline constexpr int kSidecarVersion = 1;

/// A longer text is no sidecar: a histogram of 1,024 bins and two paths take some 50 KB, and JSON takes up to 40 times
/// its bytes in memory.
inline constexpr std::uint64_t kMostSidecarBytes = std::uint64_t{4} << 20U;

/// Non-finite doubles are written as null and read back as NaN.
struct Sidecar {
  struct Time {
    double value = 0;
    std::string units;     ///< "seconds since 2000-01-01", "s"; else empty
    std::string calendar;  ///< of CF; empty, and no key, where the file names none
  };
  /// The level of refinement that the volume is, of several.
  struct Level {
    std::int64_t number = 0;  ///< 0 the coarsest
    std::int64_t count = 0;   ///< of levels: cells that one of them above `number` has are missing
  };
  /// Coordinates of index 0, 1, ... of the source along an axis; empty, and no key, where they are equally spaced.
  struct IrregularAxes {
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> z;
  };

  struct Source {
    std::string path;    ///< as the user gave it
    std::string format;  ///< "raw", "hdf5", ...
    std::string dataset;
    Index3 extent;                    ///< voxels of the volume that was read, after --roi
    std::string type;                 ///< scalar_name()
    std::uint64_t bytes = 0;          ///< size of the input file
    std::string mtime;                ///< utc_text() of the input file
    std::string digest;               ///< xxh3-128 of the float32 values, see FORMAT.md; 32 hex digits
    std::vector<std::int64_t> index;  ///< --index: position on the leading axes of the array
    std::array<std::string, 3> axes;  ///< the file's names of x, y, z, x fastest in memory; empty: not named
    std::string units;                ///< of the values, as the file says; else empty
    std::optional<double> unit_si;    ///< openPMD unitSI
    double scale = 1;                 ///< value = stored * scale + offset
    double offset = 0;
    std::string files_digest;  ///< FileStates of the files that the volume lies in; empty, and no key, where it is one
    // Each with a key where the file says it.
    std::string long_name;                        ///< "cloud water mixing ratio"
    std::string component;                        ///< of an array of vectors: "0", "1" ... or "magnitude"
    std::optional<Level> level;                   ///< of --levels separate
    std::optional<Time> time;                     ///< at which the volume is
    std::array<std::string, 3> axis_units;        ///< of the coordinates of x, y, z
    std::optional<IrregularAxes> irregular_axes;  ///< those without a spacing
    std::vector<std::string> reversed_axes;       ///< "x", "y", "z": the file has their elements in the other order
    std::string orientation;                      ///< how the axes lie in the file's world (FieldDetails::orientation)
    std::string unstored_chunks;                  ///< how many chunks the file lacks (FieldDetails::chunks_note)
    std::uint64_t values = 0;  ///< of all arrays of the input file (file_values.h); 0, and no key: not counted
    std::string real_path;     ///< what a relative `path` led to (real_path_of); empty, and no key, of others
  } source;

  struct Grid {
    std::string name;
    std::string type;  ///< grid_type_name()
    Index3 extent;     ///< voxels of the domain
    std::array<double, 3> voxel_size{1, 1, 1};
    std::array<double, 3> origin{};  ///< world position of index (0, 0, 0)
    Box index_bbox;                  ///< half open, written [[lo x, y, z], [hi x, y, z]]
  } grid;

  std::array<double, 2> value_range{};  ///< finite minimum and maximum of the source; NaN where no value is finite

  struct Nonfinite {
    std::uint64_t count = 0;       ///< voxels of the source that are NaN or infinite
    std::string policy = "error";  ///< error, background or keep
  } nonfinite;

  /// Voxels the source declares to hold no data. They read as the background, as NaN, or, under the policy keep alone,
  /// as the values that say so; then they are data, else in no error figure.
  struct Missing {
    std::uint64_t count = 0;
    std::vector<std::string> values;  ///< the stored values that say so
    std::string policy;               ///< error, background, nan or keep; empty, and no key, where weir was older
  } missing;

  /// What the conversion to float32 lost.
  struct ConversionLoss {
    std::uint64_t inexact = 0;   ///< values that float32 cannot hold
    std::uint64_t overflow = 0;  ///< values beyond float32's range
    double max_abs_error = 0;
  } conversion_loss;

  struct Background {
    double value = 0;
    std::string method;  ///< how it was found: "mode", "bin", "user", "source", ...
    double share = 0;    ///< part of the voxels with that value, 0..1; 0, not counted, for "user" and "source"
  } background;

  /// Finite source voxels equal to zero; none where weir was older.
  struct Zeros {
    std::uint64_t count = 0;
    std::uint64_t lost = 0;  ///< those that decode to another value
  };
  std::optional<Zeros> zeros;

  /// Equal bins over [min, max]; the last one includes max.
  struct Histogram {
    double min = 0;
    double max = 0;
    std::vector<std::uint64_t> counts;
  } histogram;

  struct Budget {
    std::string kind;                 ///< size, rate, psnr, max_error, lossless or minimum
    std::optional<double> requested;  ///< bytes, rate, dB or absolute error; none for lossless and minimum
    std::uint64_t file_bytes = 0;
    std::uint64_t dense_float32_bytes = 0;
    double rate = 0;  ///< dense_float32_bytes / file_bytes
  } budget;

  struct Selection {
    std::string metric;  ///< sse, farthest, closest or median
    std::string fill;    ///< mean or background
    std::int64_t brick = 8;
    std::uint64_t leaves_total = 0;
    std::uint64_t leaves_kept = 0;
    std::array<std::uint64_t, 6> bits{};  ///< kept leaves of 1, 2, 4, 8, 16 bits a voxel and float32
    /// Of a packed file, blocks by kind: without a stream, mean, transform, lattice, raw.
    std::optional<std::array<std::uint64_t, 5>> blocks;
  } selection;

  /// Of central differences, at the volume's faces those to the next voxel, as numpy.gradient has them; value per world
  /// unit.
  struct GradientError {
    double rms = 0;                      ///< root mean square of |gradient of the error|
    std::optional<double> relative_rms;  ///< that as a share of the source's; none where that is 0
    double max_abs = 0;                  ///< the largest |gradient of the error|
    std::uint64_t voxels = 0;            ///< over which it is taken
    std::uint64_t left_out = 0;          ///< those at which a value that it takes is not finite
  };

  /// Decoded values against the float32 source, all valid voxels (valid_voxels.h), in double.
  struct CertifiedError {
    double mse = 0;
    double rmse = 0;
    double nmse = 0;                ///< mse / (value range)^2
    std::optional<double> psnr_db;  ///< none where the error is 0, or all values are one
    double max_abs = 0;
    bool lossless = false;
  } error;
  std::optional<GradientError> gradient;  ///< error.gradient: none, and no key, where it was not asked for
  /// Of a packed file, what readers see that know the tree alone; its two corner leaves count as means.
  std::optional<CertifiedError> error_preview;

  /// With a scene that decided what matters: the same over the voxels of all 8^3 blocks of which something can be seen.
  struct Visible {
    std::string scene;         ///< path, as the user gave it
    std::uint64_t blocks = 0;  ///< that can be seen
    std::uint64_t voxels = 0;  ///< finite ones in them: the error is over these
    CertifiedError error;
    std::string scene_digest;  ///< of what in the scene decides the bytes; empty, and no key, where weir was older
  };
  std::optional<Visible> visible;

  /// Of a packed file (FORMAT.md).
  struct Packed {
    bool preview = false;  ///< the tree holds each block's mean
  };
  std::optional<Packed> packed;

  struct Macrocells {
    std::int64_t cell = 0;  ///< voxels along an edge
    Index3 dims;            ///< cells
    std::int64_t apron = 0;
  } macrocells;

  struct Timing {
    double survey_s = 0;
    double encode_s = 0;
    double total_s = 0;
    std::uint64_t bytes_read = 0;
    std::uint64_t bytes_written = 0;
    std::uint64_t peak_rss_bytes = 0;
  } timing;

  struct File {
    std::uint64_t bytes = 0;
    std::uint64_t grid_offset = 0;
    std::uint32_t head_checksum = 0;  ///< written as 8 hex digits
    std::string digest;               ///< xxh3-128 of the file, see FORMAT.md; 32 hex digits
  } file;

  struct Weir {
    std::string version;
    std::string commit;
    std::map<std::string, std::string> options;  ///< every option of the conversion, long names without dashes
  } weir;
};

/// "OUT.nvdb.json" for "OUT.nvdb".
std::string sidecar_path(const std::string& volume_path);

/// The JSON document, one line a top-level key, keys in the order of the struct, final newline. Finite
/// doubles read back bit-exact; bytes that are not UTF-8 (a path may hold any) become U+FFFD.
std::string to_json_text(const Sidecar& sidecar);

/// Inverse. `path` is for messages. Throws Error(input) naming the key that is missing, of the wrong
/// type or out of range, or the byte where the text stops being JSON. Unknown keys are ignored.
Sidecar parse_sidecar(std::string_view text, const std::string& path);

/// Nanoseconds since 1970-01-01 as "2026-11-21T01:39:00.123456789Z".
std::string utc_text(std::int64_t nanoseconds);

}  // namespace weir
