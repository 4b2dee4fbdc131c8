// Headers made of text: reading them within bounds, their lines and words, and
// showing what they say in a message.
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

/// How a message goes on that says which beginning a file lacks.
inline constexpr std::string_view kNotAsNamed =
    ": the file is of another format than its name says, or its beginning is lost";

/// No header is longer, but for one of a MetaImage sequence: of a file without line ends, no more than this is read.
inline constexpr std::size_t kHeaderLimit = std::size_t{1} << 20U;

/// The first `limit` bytes of a file, or all of a shorter one. Throws what InputFile's reads throw.
std::string read_head(InputFile& file, std::size_t limit = kHeaderLimit);

/// The lines of a text that lies in memory; they end in LF or CRLF, the last one perhaps in nothing.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// The next line without its end; nullopt after the last one.
  std::optional<std::string_view> next();
  /// Of the last line read, from 1.
  std::size_t number() const { return number_; }
  /// Bytes of the text up to the end of the last line read, its line end included.
  std::size_t position() const { return position_; }
  /// Whether the last line read had no line end: the text may have been cut in it.
  bool open_ended() const { return open_ended_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t number_ = 0;
  bool open_ended_ = false;
};

/// What white space separates.
std::vector<std::string_view> words(std::string_view text);
/// "'text'" for a message: one line, cut after 60 characters, what is not printable ASCII as '?'.
std::string in_quotes(std::string_view text);

/// Each word as a whole number or a finite or non-finite double; nullopt where one is none.
std::optional<std::vector<std::int64_t>> parse_ints(std::string_view text);
std::optional<std::vector<double>> parse_doubles(std::string_view text);

/// The path of a file that the header at `header_path` names: relative to the header's directory.
std::string path_beside(const std::string& header_path, std::string_view name);

}  // namespace weir
