#include "ingest/zarr/metadata/zarr_json.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::size_t kMostShown = 60;
constexpr std::size_t kMostAxes = 32;

/// The most levels of nested lists and objects. Copying a value recurses as deeply as the value is nested.
constexpr int kMostNesting = 64;

/// Returns `text` with NaN, Infinity and -Infinity, which JSON does not have, in quotes. Throws Error(input) if
/// `text` is nested too deeply.
std::string with_quoted_numbers(std::string_view text, const std::string& where) {
  constexpr std::array<std::string_view, 3> kWords{"-Infinity", "Infinity", "NaN"};
  std::string out;
  out.reserve(text.size() + kMostShown);
  bool in_string = false;
  int nesting = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto word = std::find_if(kWords.begin(), kWords.end(),
                                   [&](std::string_view w) { return !in_string && text.substr(i, w.size()) == w; });
    if (word != kWords.end()) {
      out += cat('"', *word, '"');
      i += word->size() - 1;
      continue;
    }
    out += text[i];
    if (!in_string && (text[i] == '[' || text[i] == '{') && ++nesting > kMostNesting) {
      throw input_error(where, cat("has more than ", kMostNesting, " lists and objects in each other at byte ", i,
                                   "; the file is damaged"));
    }
    if (!in_string && (text[i] == ']' || text[i] == '}')) --nesting;
    if (in_string && text[i] == '\\' && i + 1 < text.size()) {
      out += text[++i];
    } else if (text[i] == '"') {
      in_string = !in_string;
    }
  }
  return out;
}

/// Builds a document value by value, so that it can stop at the limit, and leaves out the consolidated metadata.
class ZarrDocument final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit ZarrDocument(const std::string& where) : where_(where) {}

  nlohmann::json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& value) override { return add(nlohmann::json::binary(std::move(value))); }
  bool start_object(std::size_t /*members*/) override { return open(nlohmann::json::object()); }
  bool start_array(std::size_t /*elements*/) override { return open(nlohmann::json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    key_ = std::move(name);
    left_out_ = open_.size() == 1 && key_ == "consolidated_metadata";
    return true;
  }

  bool parse_error(std::size_t byte, const std::string& /*token*/, const nlohmann::detail::exception& error) override {
    if (dynamic_cast<const nlohmann::json::parse_error*>(&error) == nullptr) {
      throw input_error(where_, "has a number that no 64-bit one holds; the file is damaged");
    }
    throw input_error(where_, cat("is no JSON at byte ", byte, "; the file is damaged or still being written"));
  }

 private:
  /// Stores `value` in the document and returns its place; returns nullptr if it is left out.
  nlohmann::json* place(nlohmann::json value) {
    if (std::exchange(left_out_, false) || (!open_.empty() && open_.back() == nullptr)) return nullptr;
    if (++values_ > kMostMetadataValues) {
      throw input_error(where_, cat("has more than ", kMostMetadataValues,
                                    " JSON values, the most that metadata may have; write long lists in its attributes "
                                    "as arrays"));
    }
    if (open_.empty()) return &(root_ = std::move(value));
    nlohmann::json& around = *open_.back();
    if (around.is_object()) return &(around[key_] = std::move(value));
    around.push_back(std::move(value));
    return &around.back();
  }
  bool add(nlohmann::json value) {
    place(std::move(value));
    return true;
  }
  bool open(nlohmann::json value) {
    open_.push_back(place(std::move(value)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  const std::string& where_;
  nlohmann::json root_;
  std::vector<nlohmann::json*>
      open_;  ///< lists and objects that have not ended, the outermost first; nullptr: left out
  std::string key_;
  bool left_out_ = false;  ///< the value of key_ is left out
  std::size_t values_ = 0;
};

}  // namespace

nlohmann::json parse_zarr_json(std::string_view text, const std::string& where) {
  ZarrDocument document(where);
  nlohmann::json::sax_parse(with_quoted_numbers(text, where), &document);
  nlohmann::json root = document.take();
  if (!root.is_object()) throw input_error(where, "is no JSON object; the file is damaged");
  return root;
}

std::size_t json_values(const nlohmann::json& value) {
  std::size_t count = 1;
  if (!value.is_structured()) return count;
  for (const nlohmann::json& inner : value) count += json_values(inner);
  return count;
}

std::string json_text(const nlohmann::json& value) {
  std::string text;
  if (value.is_structured()) {  // dump() would recurse as deeply as the value is nested
    text = value.is_array() ? cat("a list of ", value.size()) : cat("an object of ", value.size());
    return text;
  }
  text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  return text.size() <= kMostShown ? text : text.substr(0, kMostShown) + "...";
}

const nlohmann::json& json_member(const nlohmann::json& object, const char* key) {
  static const nlohmann::json kNull;
  if (!object.is_object()) return kNull;
  const auto found = object.find(key);
  return found == object.end() ? kNull : *found;
}

std::string json_string(const nlohmann::json& object, const char* key) {
  const nlohmann::json& value = json_member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::optional<StoredValue> json_number(const nlohmann::json& value) {
  if (value.is_number_unsigned()) return StoredValue{value.get<std::uint64_t>()};
  if (value.is_number_integer()) return StoredValue{value.get<std::int64_t>()};
  if (value.is_number_float()) return StoredValue{value.get<double>()};
  if (value == "NaN") return StoredValue{std::numeric_limits<double>::quiet_NaN()};
  return std::nullopt;
}

std::vector<std::int64_t> json_extents(const nlohmann::json& value, const char* name, std::int64_t least,
                                       const std::string& where) {
  const auto refuse = [&](const std::string& found) {
    return input_error(where, cat(name, " is ", found, ", and must be a list of whole numbers from ", least,
                                  " on, one for each of at most ", kMostAxes, " axes; the file is damaged"));
  };
  if (!value.is_array() || value.size() > kMostAxes) throw refuse(json_text(value));
  std::vector<std::int64_t> extents;
  for (const nlohmann::json& extent : value) {
    const bool whole = extent.is_number_unsigned() || extent.is_number_integer();
    if (!whole ||
        (extent.is_number_unsigned() && extent.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max()) ||
        extent.get<std::int64_t>() < least) {
      throw refuse(cat("one with ", json_text(extent)));
    }
    extents.push_back(extent.get<std::int64_t>());
  }
  return extents;
}

}  // namespace weir
