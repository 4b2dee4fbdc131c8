// The markup of a VTK XML file without its data. The data may be gigabytes of text between two tags, or raw bytes
// that are not XML.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

/// Takes a file's bytes from its beginning and keeps the tags. The text between two tags is replaced by its position
/// in the file, "BEGIN END" in bytes. Ends where the appended data begin. Holds up to kMaxBytes.
class VtkXmlSkeleton {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;
  static constexpr int kMaxDepth = 64;

  explicit VtkXmlSkeleton(std::string path) : path_(std::move(path)) {}

  /// Takes the next bytes of the file; returns false if no more are wanted. Throws Error(input) for declarations,
  /// which no VTK writer makes, and if markup is longer or deeper than the limits above.
  bool push(std::string_view bytes);

  /// Returns the XML so far, with the appended data element closed. A parser must check whether the XML is complete.
  std::string xml() const;
  /// The file offset of the appended data, after their underscore.
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
