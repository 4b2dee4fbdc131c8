#include "ingest/amrex/real_layout.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::string_view kWhat = "the layout of numbers";

const std::vector<std::int64_t> kSingle{32, 8, 23, 0, 1, 9, 0, 127};
const std::vector<std::int64_t> kDouble{64, 11, 52, 0, 1, 12, 0, 1023};

// Reads "(8, (64 11 52 0 1 12 0 1023))" and returns the numbers in the inner brackets.
std::vector<std::int64_t> bracketed_numbers(PlotfileText& text) {
  constexpr std::int64_t kMost = 16;
  text.expect('(', kWhat);
  const std::int64_t count = text.integer(kWhat, ",");
  if (count < 1 || count > kMost) throw text.error(cat(kWhat, " has ", count, " numbers, and must have 4 or 8"));
  text.expect(',', kWhat);
  text.expect('(', kWhat);
  std::vector<std::int64_t> all;
  for (std::int64_t i = 0; i < count; ++i) all.push_back(text.integer(kWhat, ")"));
  text.expect(')', kWhat);
  text.expect(')', kWhat);
  return all;
}

std::string listed_numbers(const std::vector<std::int64_t>& all) {
  std::string text;
  for (const std::int64_t number : all) text += cat(text.empty() ? "" : " ", number);
  return text;
}

}  // namespace

std::string real_layout_text(const RealLayout& layout) {
  return cat(layout.big_endian ? "big-endian " : "", scalar_name(layout.type));
}

RealLayout parse_real_layout(PlotfileText& text) {
  text.expect('(', kWhat);
  const std::vector<std::int64_t> format = bracketed_numbers(text);
  text.expect(',', kWhat);
  const std::vector<std::int64_t> order = bracketed_numbers(text);
  text.expect(')', kWhat);
  if (format != kSingle && format != kDouble) {
    throw text.error(cat("numbers of the format ", listed_numbers(format),
                         " cannot be read; write the plotfile in IEEE single or double precision"));
  }
  RealLayout layout;
  layout.type = format == kSingle ? ScalarType::float32 : ScalarType::float64;
  const std::size_t bytes = scalar_bytes(layout.type);
  bool rising = order.size() == bytes;
  bool falling = rising;
  for (std::size_t i = 0; i < order.size(); ++i) {
    rising = rising && order[i] == static_cast<std::int64_t>(i + 1);
    falling = falling && order[i] == static_cast<std::int64_t>(bytes - i);
  }
  if (!rising && !falling) {
    throw text.error(cat("bytes in the order ", listed_numbers(order), " cannot be read; write the plotfile with ",
                         bytes, " bytes a number in rising or falling order"));
  }
  layout.big_endian = rising;
  return layout;
}

}  // namespace weir
