// The text of a plotfile's headers: words, whole numbers, boxes and lines, one after the other. A level of a million
// boxes has headers of hundreds of megabytes, so no more than a piece is in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/index.h"

namespace weir {

/// Of a plotfile: more is damage.
inline constexpr std::int64_t kMostAmrexComponents = 100'000;

/// What is written and cannot be read, whatever else a program may still write.
class UnsupportedPlotfile : public Error {
 public:
  explicit UnsupportedPlotfile(Error error) : Error(std::move(error)) {}
};

class PlotfileText {
 public:
  /// The next bytes, valid until the next call; empty at the end.
  using NextPiece = std::function<std::string_view()>;

  /// `path` is for messages. Not thread-safe.
  PlotfileText(std::string path, NextPiece next_piece) : path_(std::move(path)), next_piece_(std::move(next_piece)) {}

  const std::string& path() const { return path_; }

  // Each of these passes white space before what it reads, but for rest_of_line, and throws Error(input) with path,
  // line, what is there and `what` should be, where there is something else.

  /// Up to the next white space or one of `stops`, which is not taken; not empty, at most kLongestWord bytes.
  std::string_view word(std::string_view what, std::string_view stops = {});
  std::int64_t integer(std::string_view what, std::string_view stops = {});
  /// From `least` to `most`.
  std::int64_t integer_in(std::string_view what, std::int64_t least, std::int64_t most);
  double real(std::string_view what, std::string_view stops = {});
  void expect(char c, std::string_view what);
  /// "((0,0,0) (31,31,31) (0,0,0))", its upper corner inclusive as AMReX writes it; half open here. Of cells only: the
  /// type of the indices must be 0. Boxes of two numbers are refused as of a 2-D plotfile.
  Box box(std::string_view what);
  /// Three whole numbers in brackets, "(2,2,1)".
  Index3 vector(std::string_view what);
  /// What is left of this line, without white space at its ends; its end is taken.
  std::string rest_of_line();
  /// Passes one word, whatever its length.
  void skip_word(std::string_view what);

  /// The next byte after white space, which is not taken; -1 at the end.
  int next_byte();
  /// "PATH: line 3: WHAT".
  Error error(const std::string& what) const;
  UnsupportedPlotfile unsupported(const std::string& what) const { return UnsupportedPlotfile(error(what)); }

  static constexpr std::size_t kLongestWord = 400;
  /// The end of what is said of plotfiles of other dimensions.
  static constexpr std::string_view kThreeAxesOnly = "; only plotfiles of three dimensions can be read";

 private:
  int peek();
  int take();
  Error wrong(std::string_view what, std::string_view found) const;

  std::string path_;
  NextPiece next_piece_;
  std::string_view piece_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  bool ended_ = false;
  std::string word_;
};

}  // namespace weir
