#include "ingest/amrex/plotfile_text.h"

#include <array>
#include <limits>

#include "format/base/ascii.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::int64_t kLeastInt = std::numeric_limits<std::int32_t>::min();  // AMReX's indices are 32-bit
constexpr std::int64_t kMostInt = std::numeric_limits<std::int32_t>::max();

}  // namespace

int PlotfileText::peek() {
  if (at_ == piece_.size() && !ended_) {
    piece_ = next_piece_();
    at_ = 0;
    ended_ = piece_.empty();
  }
  return ended_ ? -1 : static_cast<unsigned char>(piece_[at_]);
}

int PlotfileText::take() {
  const int c = peek();
  if (c < 0) return c;
  ++at_;
  if (c == '\n') ++line_;
  return c;
}

int PlotfileText::next_byte() {
  while (is_space(peek())) take();
  return peek();
}

Error PlotfileText::error(const std::string& what) const { return input_error(path_, cat("line ", line_, ": ", what)); }

Error PlotfileText::wrong(std::string_view what, std::string_view found) const {
  if (found.empty()) {
    return input_error(path_, cat("ends in line ", line_, ", where ", what,
                                  " should be; it is cut or was not written to "
                                  "its end"));
  }
  return error(cat(in_quotes(found), " should be ", what));
}

std::string_view PlotfileText::word(std::string_view what, std::string_view stops) {
  word_.clear();
  const int first = next_byte();
  if (first < 0) throw wrong(what, {});
  for (int c = first; c >= 0 && !is_space(c) && stops.find(static_cast<char>(c)) == std::string_view::npos;
       c = peek()) {
    if (word_.size() == kLongestWord) throw wrong(what, word_);
    word_ += static_cast<char>(take());
  }
  if (word_.empty()) throw wrong(what, std::string(1, static_cast<char>(first)));
  return word_;
}

void PlotfileText::skip_word(std::string_view what) {
  if (next_byte() < 0) throw wrong(what, {});
  while (peek() >= 0 && !is_space(peek())) take();
}

std::int64_t PlotfileText::integer(std::string_view what, std::string_view stops) {
  const std::string_view text = word(what, stops);
  const auto number = parse_int(text);
  if (!number) throw wrong(what, text);
  return *number;
}

std::int64_t PlotfileText::integer_in(std::string_view what, std::int64_t least, std::int64_t most) {
  const std::int64_t number = integer(what);
  if (number < least || number > most) {
    throw error(cat(what, " is ", number, ", and must be from ", least, " to ", most));
  }
  return number;
}

double PlotfileText::real(std::string_view what, std::string_view stops) {
  const std::string_view text = word(what, stops);
  const auto number = parse_double(text);
  if (!number) throw wrong(what, text);
  return *number;
}

void PlotfileText::expect(char c, std::string_view what) {
  const int found = next_byte();
  if (found == c) {
    take();
    return;
  }
  throw wrong(cat("'", c, "' of ", what), found < 0 ? std::string() : std::string(1, static_cast<char>(found)));
}

Index3 PlotfileText::vector(std::string_view what) {
  expect('(', what);
  std::array<std::int64_t, 3> numbers{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) {
      if (next_byte() == ')') {
        throw unsupported(cat(what, " has ", axis, axis == 1 ? " axis" : " axes", kThreeAxesOnly));
      }
      expect(',', what);
    }
    numbers.at(axis) = integer(what, ",)");
    if (numbers.at(axis) < kLeastInt || numbers.at(axis) > kMostInt) {
      throw error(cat(numbers.at(axis), " in ", what, " is no 32-bit number; the header is damaged"));
    }
  }
  expect(')', what);
  return {numbers[0], numbers[1], numbers[2]};
}

Box PlotfileText::box(std::string_view what) {
  expect('(', what);
  const Index3 lo = vector(what);
  const Index3 last = vector(what);
  const Index3 type = vector(what);
  expect(')', what);
  if (type != Index3{}) throw error(cat(what, " is not of cells but of faces or nodes; only cells can be read"));
  const Box box{lo, last + Index3{1, 1, 1}};
  if (box.empty()) {
    throw error(cat(what, " from (", lo.x, ',', lo.y, ',', lo.z, ") to (", last.x, ',', last.y, ',', last.z,
                    ") has no cells; the header is damaged"));
  }
  return box;
}

std::string PlotfileText::rest_of_line() {
  std::string line;
  for (int c = take(); c >= 0 && c != '\n'; c = take()) {
    if (line.size() == kLongestWord) throw wrong(cat("a line of at most ", kLongestWord, " bytes"), line);
    line += static_cast<char>(c);
  }
  return std::string(trimmed(line));
}

}  // namespace weir
