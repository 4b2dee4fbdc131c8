#include "ingest/vtk/text_values.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::size_t kValuesAtATime = 16384;
constexpr std::size_t kLongestNumber = 400;  // characters: 17 digits and an exponent tell each double

/// The words of a text.
class Words {
 public:
  explicit Words(FileText& text) : text_(text) {}

  /// Returns the next word, cut after kLongestNumber characters; empty at the end.
  std::string_view next() {
    int c = text_.next();
    while (is_space(c)) c = text_.next();
    std::size_t length = 0;
    for (; c >= 0 && !is_space(c) && length < kLongestNumber; c = text_.next()) word_[length++] = static_cast<char>(c);
    cut_ = c >= 0 && !is_space(c);
    return {word_.data(), length};
  }
  /// Returns whether the last word was cut.
  bool cut() const { return cut_; }

 private:
  FileText& text_;
  std::array<char, kLongestNumber> word_{};
  bool cut_ = false;
};

template <typename T>
bool parse(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  auto result = std::from_chars(word.data(), end, value);
  if constexpr (std::is_same_v<T, float>) {
    // A number outside the range of float is read as double and rounded to 0 or infinity.
    if (double wide = 0; result.ec == std::errc::result_out_of_range) {
      result = std::from_chars(word.data(), end, wide);
      value = static_cast<float>(wide);
    }
  }
  return result.ec == std::errc() && result.ptr == end;
}

bool parse_fraction(std::string_view word, std::uint8_t& value) {
  float fraction = 0;
  if (!parse(word, fraction)) return false;
  const double shifted = 255.0 * fraction + 0.5;
  if (!(shifted >= 0 && shifted < 256)) return false;  // refuses NaN too
  value = static_cast<std::uint8_t>(shifted);
  return true;
}

/// `parse_word` parses a word into a T and returns false if the word is no T. `kind` says what each word must be.
template <typename T, typename ParseWord>
void spool_words(Words& words, std::uint64_t count, SpoolFile& spool, const std::string& where,
                 const ParseWord& parse_word, std::string_view kind) {
  std::vector<T> values;
  values.reserve(kValuesAtATime);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string_view word = words.next();
    if (word.empty()) {
      throw Error(ErrorKind::input, cat(where, ": has ", i, " values as text, and its header asks for ", count,
                                        "; the file is cut or damaged"));
    }
    if (words.cut()) {
      throw Error(ErrorKind::input, cat(where, ": value ", i, " of its text is longer than ", kLongestNumber,
                                        " characters; write it with fewer digits"));
    }
    T value{};
    if (!parse_word(word, value)) {
      throw Error(ErrorKind::input, cat(where, ": value ", i, " of its text is ", in_quotes(word), ", no ", kind));
    }
    values.push_back(value);
    if (values.size() == kValuesAtATime || i + 1 == count) {
      spool.write(std::as_bytes(std::span(values)));
      values.clear();
    }
  }
}

template <typename T>
void spool_values(Words& words, std::uint64_t count, SpoolFile& spool, const std::string& where) {
  spool_words<T>(words, count, spool, where, parse<T>, "number of its type; correct it, or the type in the header");
}

void spool_values(Words& words, std::uint64_t count, ScalarType type, SpoolFile& spool, const std::string& where) {
  switch (type) {
    case ScalarType::uint8:
      return spool_values<std::uint8_t>(words, count, spool, where);
    case ScalarType::int8:
      return spool_values<std::int8_t>(words, count, spool, where);
    case ScalarType::uint16:
      return spool_values<std::uint16_t>(words, count, spool, where);
    case ScalarType::int16:
      return spool_values<std::int16_t>(words, count, spool, where);
    case ScalarType::uint32:
      return spool_values<std::uint32_t>(words, count, spool, where);
    case ScalarType::int32:
      return spool_values<std::int32_t>(words, count, spool, where);
    case ScalarType::uint64:
      return spool_values<std::uint64_t>(words, count, spool, where);
    case ScalarType::int64:
      return spool_values<std::int64_t>(words, count, spool, where);
    case ScalarType::float32:
      return spool_values<float>(words, count, spool, where);
    case ScalarType::float64:
      return spool_values<double>(words, count, spool, where);
    case ScalarType::float16:
    case ScalarType::bfloat16:
      break;
  }
  throw Error(ErrorKind::internal, "no text has values of this type");
}

}  // namespace

void spool_text_values(FileText& text, std::uint64_t count, ScalarType type, bool all, SpoolFile& spool,
                       const std::string& where) {
  Words words(text);
  spool_values(words, count, type, spool, where);
  if (!all) return;
  if (const std::string_view more = words.next(); !more.empty()) {
    throw Error(ErrorKind::input, cat(where, ": ", in_quotes(more), " follows the ", count,
                                      " values that its header asks for; one of the two is damaged"));
  }
}

void spool_text_fractions(FileText& text, std::uint64_t count, SpoolFile& spool, const std::string& where) {
  Words words(text);
  spool_words<std::uint8_t>(words, count, spool, where, parse_fraction,
                            "number from 0 to 1, as COLOR_SCALARS in text have them; correct it");
}

}  // namespace weir
