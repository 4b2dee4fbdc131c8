#include "ingest/source/convert_command.h"

#include <cstddef>
#include <string_view>

#include "format/base/text.h"

namespace weir {

std::string shell_word(const std::string& text) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  return word + "'";
}

namespace {

// Returns "0,0": the first position along each leading axis. Axes are named if positions alone do not tell which is
// which.
template <typename Quote>
std::string first_positions(const DatasetInfo& dataset, const Quote& quote) {
  std::string positions;
  for (std::size_t i = 0; i < dataset.leading_axes; ++i) {
    const bool named = dataset.index_by_name && i < dataset.index_axes.size() && !dataset.index_axes[i].name.empty();
    positions += cat(i == 0 ? "" : ",", named ? quote(dataset.index_axes[i].name + "=0") : "0");
  }
  return positions;
}

}  // namespace

std::string convert_command(const std::string& path, bool container, const DatasetInfo& dataset) {
  std::string command = cat("weir convert ", shell_word(path));
  if (container && !dataset.name.empty()) command += cat(" --dataset ", shell_word(dataset.name));
  if (dataset.leading_axes > 0) command += " --index " + first_positions(dataset, shell_word);
  if (dataset.components > 1) command += dataset.components <= 4 ? " --component magnitude" : " --component 0";
  return command;
}

std::string volume_keys(const DatasetInfo& dataset) {
  std::string keys = cat("dataset ", dataset.name);
  const auto as_it_is = [](const std::string& text) { return text; };
  if (dataset.leading_axes > 0) keys += ", index " + first_positions(dataset, as_it_is);
  if (dataset.components > 1) keys += dataset.components <= 4 ? ", component magnitude" : ", component 0";
  return keys;
}

}  // namespace weir
