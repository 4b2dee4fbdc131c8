// The markup of a VTK XML file without its data, which may be gigabytes of text
// between two tags, or bytes that are no XML at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

/// Takes a file's bytes from its beginning and keeps the tags; the text between two is replaced by where it lies in
/// the file, "BEGIN END" in bytes. Ends where the appended data begin. Holds up to kMaxBytes.
class VtkXmlSkeleton {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;
  static constexpr int kMaxDepth = 64;

  explicit VtkXmlSkeleton(std::string path) : path_(std::move(path)) {}

  /// Takes the next bytes of the file; false where no more are wanted. Throws Error(input) for declarations, which no
  /// VTK writer makes, and where markup is longer or deeper than these limits.
  bool push(std::string_view bytes);

  /// The XML so far, appended data closed; whether it is whole is for a parser to say.
  std::string xml() const;
  /// Where the appended data begin, behind their underscore.
  std::optional<std::uint64_t> appended() const { return appended_; }

 private:
  enum class State { text, tag, quoted, comment, before_appended, ended };

  void take(char c);
  void end_tag();
  [[noreturn]] void fail(std::string_view what) const;

  std::string path_;
  State state_ = State::text;
  std::string xml_;
  std::string tag_;
  char quote_ = 0;
  int depth_ = 0;
  bool has_text_ = false;
  std::uint64_t position_ = 0;    ///< of the next byte
  std::uint64_t text_begin_ = 0;  ///< of the text after the last tag
  std::optional<std::uint64_t> appended_;
};

}  // namespace weir
