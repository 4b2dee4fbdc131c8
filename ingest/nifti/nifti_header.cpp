#include "ingest/nifti/nifti_header.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "format/base/error.h"
#include "format/base/load_scalar.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::size_t kBytes1 = 348;
constexpr std::size_t kBytes2 = 540;

/// Byte offsets of the fields that are read. `Small` is the type of dim; `Real` is the type of pixdim, scl_slope and
/// the matrices.
struct Layout1 {
  using Small = std::int16_t;
  using Real = float;
  using Offset = float;
  using Code = std::int16_t;
  using Units = std::uint8_t;
  static constexpr std::size_t kHeader = kBytes1, kMagic = 344, kDim = 40, kDatatype = 70, kBitpix = 72, kPixdim = 76,
                               kVoxOffset = 108, kSlope = 112, kIntercept = 116, kQformCode = 252, kSformCode = 254,
                               kQuaternion = 256, kQoffset = 268, kSrow = 280, kUnits = 123, kToffset = 136;
  static constexpr std::string_view kSingle{"n+1\0", 4}, kPair{"ni1\0", 4};
};
struct Layout2 {
  using Small = std::int64_t;
  using Real = double;
  using Offset = std::int64_t;
  using Code = std::int32_t;
  using Units = std::int32_t;
  static constexpr std::size_t kHeader = kBytes2, kMagic = 4, kDim = 16, kDatatype = 12, kBitpix = 14, kPixdim = 104,
                               kVoxOffset = 168, kSlope = 176, kIntercept = 184, kQformCode = 344, kSformCode = 348,
                               kQuaternion = 352, kQoffset = 376, kSrow = 400, kUnits = 500, kToffset = 216;
  static constexpr std::string_view kSingle{"n+2\0\r\n\032\n", 8}, kPair{"ni2\0\r\n\032\n", 8};
};

struct Datatype {
  std::int16_t code;
  std::string_view name;
  std::optional<ScalarType> type;  ///< nullopt: cannot be read
};
constexpr std::array<Datatype, 17> kDatatypes{{{1, "1-bit", {}},
                                               {2, "uint8", ScalarType::uint8},
                                               {4, "int16", ScalarType::int16},
                                               {8, "int32", ScalarType::int32},
                                               {16, "float32", ScalarType::float32},
                                               {32, "complex64", {}},
                                               {64, "float64", ScalarType::float64},
                                               {128, "RGB24", {}},
                                               {256, "int8", ScalarType::int8},
                                               {512, "uint16", ScalarType::uint16},
                                               {768, "uint32", ScalarType::uint32},
                                               {1024, "int64", ScalarType::int64},
                                               {1280, "uint64", ScalarType::uint64},
                                               {1536, "float128", {}},
                                               {1792, "complex128", {}},
                                               {2048, "complex256", {}},
                                               {2304, "RGBA32", {}}}};

template <typename Layout>
class FieldReader {
 public:
  FieldReader(std::span<const std::byte> bytes, bool big_endian, const std::string& path)
      : bytes_(bytes), big_endian_(big_endian), path_(path) {}

  NiftiHeader read() const {
    NiftiHeader header;
    header.big_endian = big_endian_;
    header.pair = is_pair();
    header.extents = extents();
    header.type = type();
    header.values_offset = values_offset(header.pair);
    header.has_hidden_extensions = !header.pair && header.values_offset == Layout::kHeader + 4 &&
                                   bytes_.size() > Layout::kHeader && bytes_[Layout::kHeader] != std::byte{0};
    read_scale(header);
    read_placement(header);
    read_units(header);
    return header;
  }

 private:
  template <typename T>
  T at(std::size_t offset) const {
    return load_scalar<T>(bytes_.data() + offset, big_endian_);
  }
  double real(std::size_t offset, std::size_t i) const {
    return static_cast<double>(at<typename Layout::Real>(offset + i * sizeof(typename Layout::Real)));
  }
  template <typename T>
  Error wrong(std::string_view field, std::size_t offset, const T& value, const std::string& expected) const {
    return Error(ErrorKind::input, cat(path_, ": ", field, " at byte ", offset, " is ", value, "; ", expected));
  }

  bool is_pair() const {
    const auto stored = bytes_.subspan(Layout::kMagic, Layout::kSingle.size());
    const std::string_view magic(reinterpret_cast<const char*>(stored.data()), stored.size());
    if (magic == Layout::kSingle || magic == Layout::kPair) return magic == Layout::kPair;
    throw wrong("magic", Layout::kMagic, in_quotes(magic),
                cat("it must be ", Layout::kSingle.substr(0, 3), " or ", Layout::kPair.substr(0, 3),
                    Layout::kSingle.size() > 4 ? " and its line ends, which copying as text changes"
                                               : "; Analyze 7.5 files, which have none, cannot be read"));
  }

  std::vector<std::int64_t> extents() const {
    using Small = typename Layout::Small;
    const auto dim = [&](std::int64_t i) {
      return std::int64_t{at<Small>(Layout::kDim + static_cast<std::size_t>(i) * sizeof(Small))};
    };
    if (dim(0) < 1 || dim(0) > 7) throw wrong("dim[0]", Layout::kDim, dim(0), "it must be 1 to 7");
    std::vector<std::int64_t> extents;
    for (std::int64_t i = 1; i <= dim(0); ++i) {
      // A 0 counts as 1, as in the reference library: writers leave 0 for an axis of time or vectors that they do not
      // use.
      if (i > 3 && dim(i) == 0) {
        extents.push_back(1);
        continue;
      }
      if (dim(i) < 1) {
        throw wrong(cat("dim[", i, ']'), Layout::kDim + static_cast<std::size_t>(i) * sizeof(Small), dim(i),
                    "it must be at least 1");
      }
      extents.push_back(dim(i));
    }
    return extents;
  }

  ScalarType type() const {
    const auto code = at<std::int16_t>(Layout::kDatatype);
    const auto* const known =
        std::find_if(kDatatypes.begin(), kDatatypes.end(), [&](const Datatype& d) { return d.code == code; });
    if (known != kDatatypes.end() && known->type) {
      require_bits(*known);
      return *known->type;
    }
    throw wrong("datatype", Layout::kDatatype, cat(code, known == kDatatypes.end() ? "" : cat(" (", known->name, ')')),
                "integers of 8 to 64 bits, float32 and float64 can be read");
  }

  // By nifti1.h, bitpix must match the datatype. Some writers leave it 0.
  void require_bits(const Datatype& datatype) const {
    const auto bits = at<std::int16_t>(Layout::kBitpix);
    const std::size_t expected = 8 * scalar_bytes(*datatype.type);
    if (bits == 0 || std::cmp_equal(bits, expected)) return;
    throw wrong("bitpix", Layout::kBitpix, bits,
                cat("datatype ", datatype.code, " (", datatype.name, ") has ", expected,
                    "; correct the one of the two that is wrong"));
  }

  std::uint64_t values_offset(bool pair) const {
    const auto offset = at<typename Layout::Offset>(Layout::kVoxOffset);
    // In a single file, four bytes that announce extensions follow the header.
    const auto least = static_cast<typename Layout::Offset>(pair ? 0 : Layout::kHeader + 4);
    constexpr auto kMost = static_cast<typename Layout::Offset>(std::int64_t{1} << 62U);
    const auto whole = static_cast<double>(offset);
    if (!(offset >= least && offset <= kMost) || whole != std::floor(whole)) {
      throw wrong("vox_offset", Layout::kVoxOffset, offset, cat("it must be a whole number, at least ", least));
    }
    return static_cast<std::uint64_t>(offset);
  }

  // "If scl_slope is nonzero, then each voxel value should be scaled"; writers also leave NaN for "no scale".
  void read_scale(NiftiHeader& header) const {
    const double slope = real(Layout::kSlope, 0);
    if (slope == 0 || std::isnan(slope)) return;
    if (!std::isfinite(slope)) throw wrong("scl_slope", Layout::kSlope, slope, "it must be finite");
    const double intercept = real(Layout::kIntercept, 0);
    if (!std::isfinite(intercept)) {
      throw wrong("scl_inter", Layout::kIntercept, intercept, cat("with scl_slope ", slope, " it must be finite"));
    }
    header.slope = slope;
    header.intercept = intercept;
  }

  void read_placement(NiftiHeader& header) const {
    for (std::size_t a = 0; a < 3; ++a) {
      // As in the reference library: an invalid length counts as 1.
      const double length = std::fabs(real(Layout::kPixdim, a + 1));
      header.spacing[a] = std::isfinite(length) && length > 0 ? length : 1.0;
      header.steps[a][a] = header.spacing[a];
    }
    if (coded(Layout::kSformCode)) {
      if (take(header, sform())) {
        header.steps_rule = true;
        return;
      }
      header.placement_note = "its sform has a column that is zero or not finite; the place is that of ";
    }
    const bool qform_taken = coded(Layout::kQformCode) && take(header, qform(header.spacing));
    if (coded(Layout::kQformCode) && !qform_taken) {
      header.placement_note = header.placement_note.empty()
                                  ? "its qform is not finite; the place is that of "
                                  : "neither its sform nor its qform can be used; the place is that of ";
    }
    if (!header.placement_note.empty()) header.placement_note += qform_taken ? "the qform" : "pixdim";
  }

  bool coded(std::size_t code) const { return at<typename Layout::Code>(code) > 0; }

  struct Affine {
    std::array<Vector3, 3> steps{};
    Vector3 first{};
  };

  // Uses `affine` if it is finite and has a step other than zero along each axis. Returns whether it does.
  static bool take(NiftiHeader& header, const Affine& affine) {
    const auto finite = [](const Vector3& v) {
      return std::ranges::all_of(v, [](double part) { return std::isfinite(part); });
    };
    const std::size_t axes = std::min<std::size_t>(3, header.extents.size());
    const bool valid =
        finite(affine.first) && std::all_of(affine.steps.begin(), affine.steps.begin() + axes,
                                            [&](const Vector3& step) { return finite(step) && step != Vector3{}; });
    if (!valid) return false;
    header.steps = affine.steps;
    header.first = affine.first;
    return true;
  }

  Affine sform() const {
    Affine affine;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t a = 0; a < 3; ++a) affine.steps[a][c] = real(Layout::kSrow, 4 * c + a);
      affine.first[c] = real(Layout::kSrow, 4 * c + 3);
    }
    return affine;
  }

  // xyzt_units: the lowest three bits are the unit of length, the next three the unit of time. Codes of 32 and above,
  // frequencies for example, are ignored.
  void read_units(NiftiHeader& header) const {
    constexpr std::array<std::string_view, 8> kLengthUnits{"", "m", "mm", "um"};
    constexpr std::array<std::string_view, 8> kTimeUnits{"", "s", "ms", "us"};
    const auto code = static_cast<std::uint32_t>(at<typename Layout::Units>(Layout::kUnits));
    header.length_unit = kLengthUnits[code & 7U];
    if (header.extents.size() < 4) return;
    header.time_unit = kTimeUnits[code >> 3U & 7U];
    header.time_offset = real(Layout::kToffset, 0);
    header.time_step = real(Layout::kPixdim, 4);
  }

  // nifti1.h, "METHOD 2". The quaternion's component a is not stored; it is not negative.
  Affine qform(const Vector3& spacing) const {
    Affine affine;
    const double b = real(Layout::kQuaternion, 0);
    const double c = real(Layout::kQuaternion, 1);
    const double d = real(Layout::kQuaternion, 2);
    const double a = std::sqrt(std::max(0.0, 1.0 - (b * b + c * c + d * d)));
    const std::array<Vector3, 3> columns{{{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
                                          {2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
                                          {2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c}}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double side = axis == 2 && real(Layout::kPixdim, 0) < 0 ? -1.0 : 1.0;  // qfac
      for (std::size_t w = 0; w < 3; ++w) affine.steps[axis][w] = columns[axis][w] * spacing[axis] * side;
      affine.first[axis] = real(Layout::kQoffset, axis);
    }
    return affine;
  }

  std::span<const std::byte> bytes_;
  bool big_endian_;
  const std::string& path_;
};

/// Returns the byte order in which the first four bytes are a header's size; nullopt if they are in neither order.
std::optional<bool> is_big_endian(std::span<const std::byte> head) {
  if (head.size() < 4) return std::nullopt;
  for (const bool big_endian : {false, true}) {
    const auto size = load_scalar<std::uint32_t>(head.data(), big_endian);
    if (size == kBytes1 || size == kBytes2) return big_endian;
  }
  return std::nullopt;
}

}  // namespace

bool begins_like_nifti(std::span<const std::byte> head) { return is_big_endian(head).has_value(); }

NiftiHeader parse_nifti_header(std::span<const std::byte> bytes, const std::string& path) {
  const std::optional<bool> big_endian = is_big_endian(bytes);
  if (!big_endian) {
    throw Error(ErrorKind::input, cat(path, ": is no NIfTI file: its first four bytes are neither 348 nor 540"));
  }
  const auto size = load_scalar<std::uint32_t>(bytes.data(), *big_endian);
  if (bytes.size() < size) {
    throw Error(ErrorKind::input, cat(path, ": ends after ", bytes.size(), " bytes, its header alone has ", size));
  }
  return size == kBytes1 ? FieldReader<Layout1>(bytes, *big_endian, path).read()
                         : FieldReader<Layout2>(bytes, *big_endian, path).read();
}

}  // namespace weir
