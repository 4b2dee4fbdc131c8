// Helpers for text headers: bounded reading, lines and words, and quoting header text in a message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/ascii.h"
#include "ingest/files/input_file.h"

namespace weir {

/// The end of a message about a file that lacks the beginning of its format.
inline constexpr std::string_view kNotAsNamed =
    ": the file is of another format than its name says, or its beginning is lost";

/// The longest header, except that of a MetaImage sequence. At most this much is read of a file without line ends.
inline constexpr std::size_t kHeaderLimit = std::size_t{1} << 20U;

/// Returns the first `limit` bytes of a file, or all of a shorter file. Throws the errors of InputFile's reads.
std::string read_head(InputFile& file, std::size_t limit = kHeaderLimit);

/// Reads the lines of a text in memory. Lines end in LF or CRLF; the last line may have no end.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// Returns the next line without its end; nullopt after the last line.
  std::optional<std::string_view> next();
  /// Number of the last line read, from 1.
  std::size_t number() const { return number_; }
  /// Bytes of the text up to the end of the last line read, including its line end.
  std::size_t position() const { return position_; }
  /// Whether the last line read had no line end: the text may be cut in it.
  bool open_ended() const { return open_ended_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t number_ = 0;
  bool open_ended_ = false;
};

/// Returns the words of the text, which white space separates.
std::vector<std::string_view> words(std::string_view text);
/// Returns "'text'" for a message: one line, cut after 60 characters, with '?' for anything but printable ASCII.
std::string in_quotes(std::string_view text);

/// Return all words as whole numbers, or as doubles (also non-finite); nullopt if a word is not a number.
std::optional<std::vector<std::int64_t>> parse_ints(std::string_view text);
std::optional<std::vector<double>> parse_doubles(std::string_view text);

/// Returns the path of a file that the header at `header_path` names, relative to the header's directory.
std::string path_beside(const std::string& header_path, std::string_view name);

}  // namespace weir
