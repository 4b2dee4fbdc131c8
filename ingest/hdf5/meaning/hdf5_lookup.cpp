#include "ingest/hdf5/meaning/hdf5_lookup.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_walk.h"

namespace weir {
namespace {

constexpr std::size_t kMostNearNames = 8;  // in a message

std::vector<std::string> dataset_names(hid_t file, const std::string& group) {
  std::vector<std::string> names;
  walk_datasets(
      file, group, [&](std::string name, const Hdf5Handle&) { names.push_back(std::move(name)); },
      [](const UnreadObject&) {});  // they are for a message
  return names;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNearNames); ++i) text += cat(i == 0 ? "" : ", ", names[i]);
  if (names.size() > kMostNearNames)
    text += cat(" and ", names.size() - kMostNearNames, " more (weir inspect lists them)");
  return text;
}

// If the link `name` exists but its target does not, returns the target that the link states; otherwise empty.
std::string dangling_target(hid_t file, const std::string& name) {
  H5L_info_t info;
  if (H5Lget_info(file, name.c_str(), &info, H5P_DEFAULT) < 0) return {};
  constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
  if (info.type == H5L_TYPE_HARD || info.u.val_size == 0 || info.u.val_size > kMostBytes) return {};
  std::vector<char> value(info.u.val_size + 1, '\0');
  if (H5Lget_val(file, name.c_str(), value.data(), info.u.val_size, H5P_DEFAULT) < 0) return {};
  if (info.type == H5L_TYPE_SOFT) return cat("a soft link to ", value.data(), ", which is not there");
  const char* other_file = nullptr;
  const char* object = nullptr;
  if (info.type != H5L_TYPE_EXTERNAL ||
      H5Lunpack_elink_val(value.data(), info.u.val_size, nullptr, &other_file, &object) < 0) {
    return {};
  }
  return cat("a link to ", object, " of the file ", other_file, ", which is not there; put the file beside this one");
}

Error missing(hid_t file, const std::string& path, const std::string& name) {
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    if (const std::string target = dangling_target(file, part); !target.empty()) {
      if (Hdf5Handle(H5Oopen(file, part.c_str(), H5P_DEFAULT))) continue;
      return {ErrorKind::input, cat(path, ": ", part, ": ", target)};
    }
    if (end == std::string::npos) break;
  }
  const std::vector<std::string> names = dataset_names(file, "/");
  if (names.empty()) return {ErrorKind::input, cat(path, ": no dataset ", name, "; the file holds none at all")};
  const std::vector<std::string> near = near_names(name, names, kMostNearNames);
  if (!near.empty()) {
    return {ErrorKind::input,
            cat(path, ": no dataset ", name, "; did you mean ", joined(near), "? weir inspect lists all")};
  }
  return {ErrorKind::input, cat(path, ": no dataset ", name, "; the file holds ", joined(names))};
}

Error group_given(hid_t file, const std::string& path, const std::string& name) {
  const std::vector<std::string> names = dataset_names(file, name);
  if (names.empty()) return {ErrorKind::input, cat(path, ": ", name, " is a group, and holds no dataset")};
  return {ErrorKind::input, cat(path, ": ", name, " is a group; give one of its datasets: ", joined(names))};
}

}  // namespace

Hdf5Object find_dataset(hid_t file, const std::string& path, const std::string& name) {
  Hdf5Object found{{}, path, name.starts_with('/') ? name : '/' + name};
  while (found.name.size() > 1 && found.name.ends_with('/')) found.name.pop_back();
  found.handle = Hdf5Handle(H5Oopen(file, found.name.c_str(), H5P_DEFAULT));
  if (!found.handle) {
    H5L_info_t info;
    const std::string reason = hdf5_reason();
    // A hard link exists, but its target cannot be read.
    if (H5Lget_info(file, found.name.c_str(), &info, H5P_DEFAULT) >= 0 && info.type == H5L_TYPE_HARD) {
      throw Error(ErrorKind::input, cat(found.where(), ": cannot be opened: ", reason, "; the file is damaged"));
    }
    throw missing(file, path, found.name);
  }
  if (is_dataset(found.handle.get()) || is_openpmd_constant(found.handle.get())) return found;
  if (H5Iget_type(found.handle.get()) == H5I_GROUP) throw group_given(file, path, found.name);
  throw Error(ErrorKind::input, cat(found.where(), ": a named type, no dataset"));
}

namespace {

constexpr std::size_t kMostEdits = 2;

std::string last_part_lowered(std::string_view path) { return lower_case(path.substr(path.rfind('/') + 1)); }

// Levenshtein's distance, a row at a time.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({row[j] + 1, row[j + 1] + 1, replaced}));
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string> near_names(std::string_view wanted, std::span<const std::string> names, std::size_t count) {
  const std::string target = last_part_lowered(wanted);
  const std::size_t most = std::min(kMostEdits, target.size() / 3);
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const std::string& name : names) {
    const std::string part = last_part_lowered(name);
    if (part.size() > target.size() + most || target.size() > part.size() + most) continue;
    if (const std::size_t distance = edits(target, part); distance <= most) near.emplace_back(distance, name);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> nearest;
  for (auto& [distance, name] : near) {
    if (nearest.size() < count) nearest.push_back(std::move(name));
  }
  return nearest;
}

}  // namespace weir
