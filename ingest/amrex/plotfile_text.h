// Parses the text of a plotfile's headers: a sequence of words, whole numbers, boxes and lines. A level of a million
// boxes has headers of hundreds of megabytes, so only a piece is held in memory.
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

/// The most components of a plotfile. A larger number is treated as damage.
inline constexpr std::int64_t kMostAmrexComponents = 100'000;

/// The error for a plotfile that cannot be read, whatever a program may still write to it.
class UnsupportedPlotfile : public Error {
 public:
  explicit UnsupportedPlotfile(Error error) : Error(std::move(error)) {}
};

class PlotfileText {
 public:
  /// Returns the next bytes, valid until the next call; empty at the end.
  using NextPiece = std::function<std::string_view()>;

  /// `path` is for messages. Not thread-safe.
  PlotfileText(std::string path, NextPiece next_piece) : path_(std::move(path)), next_piece_(std::move(next_piece)) {}

  const std::string& path() const { return path_; }

  // Each function below skips white space first, except rest_of_line. It throws Error(input) if it finds anything
  // else than it expects; the message has path, line, the text found, and `what`, the name of the expected thing.

  /// Returns the text up to the next white space or one of `stops`, which stays unread. It is not empty and has at
  /// most kLongestWord bytes.
  std::string_view word(std::string_view what, std::string_view stops = {});
  std::int64_t integer(std::string_view what, std::string_view stops = {});
  /// The number must be from `least` to `most`.
  std::int64_t integer_in(std::string_view what, std::int64_t least, std::int64_t most);
  double real(std::string_view what, std::string_view stops = {});
  void expect(char c, std::string_view what);
  /// Reads a box, "((0,0,0) (31,31,31) (0,0,0))". AMReX writes its upper corner inclusive; the returned box is half
  /// open. The type of the indices must be 0 (cells). A box of two numbers is refused as a 2-D plotfile's.
  Box box(std::string_view what);
  /// Reads three whole numbers in brackets, "(2,2,1)".
  Index3 vector(std::string_view what);
  /// Returns the rest of this line, without white space at its ends. Also skips the line end.
  std::string rest_of_line();
  /// Skips one word of any length.
  void skip_word(std::string_view what);

  /// Skips white space and returns the next byte, which stays unread; -1 at the end.
  int next_byte();
  /// Returns the error "PATH: line 3: WHAT".
  Error error(const std::string& what) const;
  UnsupportedPlotfile unsupported(const std::string& what) const { return UnsupportedPlotfile(error(what)); }

  static constexpr std::size_t kLongestWord = 400;
  /// The end of messages about plotfiles that are not 3-D.
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
