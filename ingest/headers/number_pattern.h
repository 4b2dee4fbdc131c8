// Names with a running number: 'plane_%05d.raw', '/data/%d/meshes/rho'.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// A name with one %d, %Nd or %0Nd in it, as printf understands them but for signs.
class NumberPattern {
 public:
  /// nullopt where the text has no such place, or several.
  static std::optional<NumberPattern> parse(std::string_view text);

  /// The number that makes this pattern `name`; nullopt where none below 2^63 does.
  std::optional<std::int64_t> match(std::string_view name) const;
  /// The name of `number`, which is not negative.
  std::string name(std::int64_t number) const;
  /// What is left without the number and the separators (_ - . space) before it.
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

/// Whatever `pattern`, a path with a number in its last part, names, by rising number: what cannot be read as a volume,
/// a link to nothing for instance, too, since a series must not leave out a step without a word. Throws Error(input)
/// where the directory cannot be read or no name in it matches, Error(usage) where the text is no such pattern.
std::vector<NumberedFile> numbered_files(const std::string& pattern);

/// With as many zeros before it as `largest` has digits more: names sort by number.
std::string padded_number(std::int64_t number, std::int64_t largest);
/// Both with "_" between; one of them where the other is empty.
std::string joined_name(const std::string& a, const std::string& b);

}  // namespace weir
