// The sidecar OUT.nvdb.json: what one conversion read, chose, lost and wrote. The struct holds every key of the JSON
// document under the same name; the schema is format/sidecar.schema.json. Plain data, no invariants. "No key" below
// means that the document then lacks the key.
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

/// The most bytes of a sidecar: a histogram of 1,024 bins and two paths take some 50 KB, and JSON takes up to 40 times
/// its bytes in memory.
inline constexpr std::uint64_t kMostSidecarBytes = std::uint64_t{4} << 20U;

/// Non-finite doubles are written as null and read back as NaN.
struct Sidecar {
  struct Time {
    double value = 0;
    std::string units;     ///< "seconds since 2000-01-01", "s"; empty if unknown
    std::string calendar;  ///< the CF calendar; empty, and no key, if the file names none
  };
  /// The volume's level of refinement, if the source has several.
  struct Level {
    std::int64_t number = 0;  ///< 0 is the coarsest
    std::int64_t count = 0;   ///< number of levels; cells that a level above `number` covers are missing
  };
  /// Coordinates of index 0, 1, ... of the source along an axis; empty, and no key, if they are equally spaced.
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
    std::string units;                ///< of the values, as the file says; empty if it does not
    std::optional<double> unit_si;    ///< openPMD unitSI
    double scale = 1;                 ///< value = stored * scale + offset
    double offset = 0;
    std::string files_digest;  ///< FileStates of the files that hold the volume; empty, and no key, if there is only
                               ///< one
    // Each of these has a key only if the file says it.
    std::string long_name;                        ///< "cloud water mixing ratio"
    std::string component;                        ///< component of an array of vectors: "0", "1" ... or "magnitude"
    std::optional<Level> level;                   ///< with --levels separate
    std::optional<Time> time;                     ///< time of the volume
    std::array<std::string, 3> axis_units;        ///< units of the coordinates of x, y, z
    std::optional<IrregularAxes> irregular_axes;  ///< axes without equal spacing
    std::vector<std::string> reversed_axes;       ///< "x", "y", "z": the file stores their elements in reverse order
    std::string orientation;                      ///< the axes' directions in the file's world
                                                  ///< (FieldDetails::orientation)
    std::string unstored_chunks;                  ///< the number of chunks that the file lacks
                                                  ///< (FieldDetails::chunks_note)
    std::uint64_t values = 0;  ///< values of all arrays of the input file (file_values.h); 0, and no key: not counted
    std::string real_path;     ///< the target of a relative `path` (real_path_of); empty, and no key, for an absolute
                               ///< one
  } source;

  struct Grid {
    std::string name;
    std::string type;  ///< grid_type_name()
    Index3 extent;     ///< voxels of the domain
    std::array<double, 3> voxel_size{1, 1, 1};
    std::array<double, 3> origin{};  ///< world position of index (0, 0, 0)
    Box index_bbox;                  ///< half open, written [[lo x, y, z], [hi x, y, z]]
  } grid;

  std::array<double, 2> value_range{};  ///< finite minimum and maximum of the source; NaN if no value is finite

  struct Nonfinite {
    std::uint64_t count = 0;       ///< voxels of the source that are NaN or infinite
    std::string policy = "error";  ///< error, background or keep
  } nonfinite;

  /// Voxels that the source declares to hold no data. They read as the background, as NaN, or, only with the policy
  /// keep, as their stored values. With keep they count as data; otherwise they are in no error figure.
  struct Missing {
    std::uint64_t count = 0;
    std::vector<std::string> values;  ///< the stored values that mean "no data"
    std::string policy;               ///< error, background, nan or keep; empty, and no key, in files of older weir
  } missing;

  /// The loss of the conversion to float32.
  struct ConversionLoss {
    std::uint64_t inexact = 0;   ///< values that float32 cannot hold
    std::uint64_t overflow = 0;  ///< values beyond float32's range
    double max_abs_error = 0;
  } conversion_loss;

  struct Background {
    double value = 0;
    std::string method;  ///< how it was found: "mode", "bin", "user", "source", ...
    double share = 0;    ///< share of the voxels with that value, 0..1; 0, not counted, for "user" and "source"
  } background;

  /// Finite source voxels equal to zero; absent in files of older weir.
  struct Zeros {
    std::uint64_t count = 0;
    std::uint64_t lost = 0;  ///< zeros that decode to another value
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
    /// For a packed file, blocks by kind: without a stream, mean, transform, lattice, raw.
    std::optional<std::array<std::uint64_t, 5>> blocks;
  } selection;

  /// The error of central differences, at the volume's faces of one-sided differences, as numpy.gradient computes them;
  /// value per world unit.
  struct GradientError {
    double rms = 0;                      ///< root mean square of |gradient of the error|
    std::optional<double> relative_rms;  ///< `rms` as a share of the source's; none if the source's is 0
    double max_abs = 0;                  ///< the largest |gradient of the error|
    std::uint64_t voxels = 0;            ///< number of voxels that it covers
    std::uint64_t left_out = 0;          ///< voxels left out because a value of the difference is not finite
  };

  /// Error of the decoded values against the float32 source, over all valid voxels (valid_voxels.h), computed in
  /// double.
  struct CertifiedError {
    double mse = 0;
    double rmse = 0;
    double nmse = 0;                ///< mse / (value range)^2
    std::optional<double> psnr_db;  ///< none if the error is 0, or if all values are equal
    double max_abs = 0;
    bool lossless = false;
  } error;
  std::optional<GradientError> gradient;  ///< error.gradient: none, and no key, if it was not requested
  /// For a packed file, the error that readers see that know only the tree; its two corner leaves count as means.
  std::optional<CertifiedError> error_preview;

  /// The error over the voxels of all 8^3 blocks with something visible, if a scene decided what matters.
  struct Visible {
    std::string scene;         ///< path, as the user gave it
    std::uint64_t blocks = 0;  ///< visible blocks
    std::uint64_t voxels = 0;  ///< finite voxels of the visible blocks; the error covers these
    CertifiedError error;
    std::string scene_digest;  ///< digest of the parts of the scene that affect the bytes; empty, and no key, in files
                               ///< of older weir
  };
  std::optional<Visible> visible;

  /// For a packed file (FORMAT.md).
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

/// Returns "OUT.nvdb.json" for "OUT.nvdb".
std::string sidecar_path(const std::string& volume_path);

/// Returns the JSON document: one line per top-level key, keys in the order of the struct, a final newline. Finite
/// doubles read back bit-exact; bytes that are not UTF-8 (a path may hold any) become U+FFFD.
std::string to_json_text(const Sidecar& sidecar);

/// Parses a JSON document of to_json_text(). `path` is for messages. Throws Error(input) that names the key that is
/// missing, of the wrong type or out of range, or the byte at which the text stops being JSON. Ignores unknown keys.
Sidecar parse_sidecar(std::string_view text, const std::string& path);

/// Returns nanoseconds since 1970-01-01 as "2026-11-21T01:39:00.123456789Z".
std::string utc_text(std::int64_t nanoseconds);

}  // namespace weir
