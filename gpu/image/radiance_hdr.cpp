#include "gpu/image/radiance_hdr.h"

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

namespace {

constexpr std::int32_t kLeastPackedWidth = 8;      // scanlines outside these widths
constexpr std::int32_t kMostPackedWidth = 0x7fff;  // are never packed by component

using Rgbe = std::array<std::uint8_t, 4>;

Float3 decode(const Rgbe& p) {
  if (p[3] == 0) return {};
  const float unit = std::ldexp(1.0F, p[3] - (128 + 8));
  return Float3{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])} * unit;
}

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  std::uint8_t byte() {
    if (at_ == bytes_.size()) fail("the file ends here, in the middle of the picture; it was cut short");
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }
  Rgbe pixel() {
    Rgbe p{};
    for (std::uint8_t& component : p) component = byte();
    return p;
  }
  /// Returns a line of the header without its end, which is a line feed or Windows's two characters.
  std::string_view line() {
    const char* first = reinterpret_cast<const char*>(bytes_.data()) + at_;
    const std::string_view rest(first, bytes_.size() - at_);
    const std::size_t length = rest.find('\n');
    if (length == std::string_view::npos) fail("the header does not end; give a Radiance .hdr file");
    at_ += length + 1;
    const bool carriage_return = length > 0 && rest[length - 1] == '\r';
    return rest.substr(0, carriage_return ? length - 1 : length);
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::input, cat(path_, ": offset ", at_, ": ", message));
  }

 private:
  std::span<const std::byte> bytes_;
  const std::string& path_;
  std::size_t at_ = 0;
};

// "-Y HEIGHT +X WIDTH"
void read_size(Reader& reader, std::int32_t& width, std::int32_t& height) {
  const std::string line(reader.line());
  const std::vector<std::string> words = split(line, ' ');
  if (words.size() != 4 || words[0] != "-Y" || words[2] != "+X") {
    reader.fail(cat("the size is \"", line.substr(0, 60), "\", only -Y HEIGHT +X WIDTH (rows from the top) is read"));
  }
  const auto h = parse_int(words[1]);
  const auto w = parse_int(words[3]);
  if (!h || !w || *h < 1 || *w < 1 || *h > INT32_MAX || *w > INT32_MAX) {
    reader.fail(cat("the size is \"", line.substr(0, 60), "\", it must be two whole numbers above 0"));
  }
  width = static_cast<std::int32_t>(*w);
  height = static_cast<std::int32_t>(*h);
}

// Reads one component of a scanline: runs (length + 128, value) and literals (length, values).
void read_component(Reader& reader, std::vector<Rgbe>& row, std::size_t component) {
  for (std::size_t x = 0; x < row.size();) {
    const std::uint8_t code = reader.byte();
    const bool run = code > 128;
    const std::size_t count = run ? code - 128U : code;
    if (count == 0 || count > row.size() - x) {
      reader.fail(
          cat("a run of ", count, " where ", row.size() - x, " pixels are left in the row; the file is broken"));
    }
    const std::uint8_t value = run ? reader.byte() : std::uint8_t{0};
    for (std::size_t i = 0; i < count; ++i) row[x++][component] = run ? value : reader.byte();
  }
}

// Reads a scanline pixel by pixel, as old files store it. (1, 1, 1, n) repeats the previous pixel n times. If several
// follow each other, they are the digits of n, the lowest first.
void read_flat(Reader& reader, std::vector<Rgbe>& row, Rgbe first) {
  int shift = 0;
  Rgbe p = first;
  for (std::size_t x = 0;;) {
    if (p[0] == 1 && p[1] == 1 && p[2] == 1 && x > 0) {
      const std::size_t count = shift > 24 ? row.size() : static_cast<std::size_t>(p[3]) << shift;
      if (count > row.size() - x) reader.fail(cat("a run longer than the row; the file is broken"));
      for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    } else {
      row[x++] = p;
      shift = 0;
    }
    if (x == row.size()) return;
    p = reader.pixel();
  }
}

void read_row(Reader& reader, std::vector<Rgbe>& row) {
  const auto width = static_cast<std::int32_t>(row.size());
  const Rgbe head = reader.pixel();
  const bool packed =
      width >= kLeastPackedWidth && width <= kMostPackedWidth && head[0] == 2 && head[1] == 2 && (head[2] & 0x80U) == 0;
  if (!packed) return read_flat(reader, row, head);
  if ((head[2] << 8 | head[3]) != width) {
    reader.fail(cat("a row of ", head[2] << 8 | head[3], " pixels in a picture ", width, " wide; the file is broken"));
  }
  for (std::size_t component = 0; component < 4; ++component) read_component(reader, row, component);
}

}  // namespace

bool is_radiance_hdr(std::span<const std::byte> bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 16));
  return head.starts_with("#?RADIANCE") || head.starts_with("#?RGBE");
}

Image decode_radiance_hdr(std::span<const std::byte> bytes, const std::string& path, const ImageSizeCheck& check) {
  Reader reader(bytes, path);
  for (std::string_view line = reader.line(); !line.empty(); line = reader.line()) {
    constexpr std::string_view kFormat = "FORMAT=";
    if (line.starts_with(kFormat) && line.substr(kFormat.size()) != "32-bit_rle_rgbe") {
      reader.fail(cat("the format is \"", line.substr(kFormat.size(), 40), "\", only 32-bit_rle_rgbe is read"));
    }
  }
  std::int32_t width = 0;
  std::int32_t height = 0;
  read_size(reader, width, height);
  check(width, height);
  Image image(width, height);
  std::vector<Rgbe> row(static_cast<std::size_t>(width));
  for (std::int32_t y = 0; y < height; ++y) {
    read_row(reader, row);
    for (std::int32_t x = 0; x < width; ++x) image.pixels[image.index(x, y)] = decode(row[static_cast<std::size_t>(x)]);
  }
  return image;
}

}  // namespace weir
