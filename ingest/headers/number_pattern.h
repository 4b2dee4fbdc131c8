// Names with a running number: 'plane_%05d.raw', '/data/%d/meshes/rho'.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// A name with one %d, %Nd or %0Nd in it, as in printf, but for numbers without a sign.
class NumberPattern {
 public:
  /// Returns the pattern in `text`; nullopt if `text` has no place for a number, or several.
  static std::optional<NumberPattern> parse(std::string_view text);

  /// Returns the number for which this pattern gives `name`; nullopt if no number below 2^63 does.
  std::optional<std::int64_t> match(std::string_view name) const;
  /// Returns the name for `number`, which must not be negative.
  std::string name(std::int64_t number) const;
  /// Returns the name without its extension, the number, and the separators (_ - . space) before the number.
  std::string stem() const;

 private:
  std::string prefix_;
  std::string suffix_;
  std::size_t width_ = 0;
  char pad_ = ' ';
};

struct NumberedFile {
  std::int64_t number = 0;
  std::string path;
};

/// Returns all files that `pattern` names, by rising number. The last part of `pattern`, a path, has the number.
/// Files that cannot be read as a volume, for example a link to nothing, are returned too, so that a series does not
/// silently leave out a step. Throws Error(input) if the directory cannot be read or no name in it matches, and
/// Error(usage) if the text is not such a pattern.
std::vector<NumberedFile> numbered_files(const std::string& pattern);

/// Returns the number, padded with zeros to as many digits as `largest` has, so that names sort by number.
std::string padded_number(std::int64_t number, std::int64_t largest);
/// Returns both names with "_" between; if one is empty, the other.
std::string joined_name(const std::string& a, const std::string& b);

}  // namespace weir
