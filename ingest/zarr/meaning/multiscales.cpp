#include "ingest/zarr/meaning/multiscales.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

constexpr std::size_t kMostLevels = 100;
constexpr std::size_t kMostImageAxes = 32;

std::optional<std::vector<double>> numbers_in(const nlohmann::json& list) {
  if (!list.is_array() || list.empty() || list.size() > kMostImageAxes) return std::nullopt;
  std::vector<double> numbers;
  for (const nlohmann::json& number : list) {
    if (!number.is_number()) return std::nullopt;
    numbers.push_back(number.get<double>());
  }
  return numbers;
}

double at_or(const std::vector<double>& numbers, std::size_t i, double otherwise) {
  return i < numbers.size() ? numbers[i] : otherwise;
}

/// Appends a list of transformations to those in `level`. Returns false if one is not identity, scale or translation
/// by numbers.
bool transform(const nlohmann::json& list, ScaleLevel& level) {
  if (list.is_null()) return true;
  if (!list.is_array() || list.size() > kMostImageAxes) return false;
  for (const nlohmann::json& step : list) {
    const std::string type = json_string(step, "type");
    if (type == "identity") continue;
    const auto numbers = numbers_in(json_member(step, type.c_str()));
    if ((type != "scale" && type != "translation") || !numbers) return false;
    if (!level.scale.empty() && level.scale.size() != numbers->size()) return false;
    std::vector<double> scale(numbers->size());
    std::vector<double> translation(numbers->size());
    for (std::size_t i = 0; i < numbers->size(); ++i) {
      const double factor = type == "scale" ? (*numbers)[i] : 1.0;
      const double offset = type == "scale" ? 0.0 : (*numbers)[i];
      scale[i] = at_or(level.scale, i, 1.0) * factor;
      translation[i] = at_or(level.translation, i, 0.0) * factor + offset;
    }
    level.scale = std::move(scale);
    level.translation = std::move(translation);
  }
  return true;
}

std::vector<ScaleAxis> axes_in(const nlohmann::json& list) {
  std::vector<ScaleAxis> axes;
  if (!list.is_array() || list.size() > kMostImageAxes) return axes;
  for (const nlohmann::json& axis : list) {
    // Version 0.3 has only names of axes.
    axes.push_back(axis.is_string()
                       ? ScaleAxis{axis.get<std::string>(), {}, {}}
                       : ScaleAxis{json_string(axis, "name"), json_string(axis, "type"), json_string(axis, "unit")});
  }
  return axes;
}

}  // namespace

std::vector<Multiscale> multiscales_in(const nlohmann::json& attributes) {
  const nlohmann::json& ome = json_member(attributes, "ome");
  const nlohmann::json& list = json_member(ome.is_object() ? ome : attributes, "multiscales");
  std::vector<Multiscale> images;
  if (!list.is_array()) return images;
  for (const nlohmann::json& entry : list) {
    Multiscale image;
    image.axes = axes_in(json_member(entry, "axes"));
    const nlohmann::json& datasets = json_member(entry, "datasets");
    for (std::size_t i = 0; datasets.is_array() && i < std::min(datasets.size(), kMostLevels); ++i) {
      ScaleLevel level;
      level.path = without_slashes(json_string(datasets[i], "path"));
      if (level.path.empty()) continue;
      level.placed = transform(json_member(datasets[i], "coordinateTransformations"), level) &&
                     transform(json_member(entry, "coordinateTransformations"), level);
      if (!level.placed) level = {level.path, {}, {}, false};
      image.levels.push_back(std::move(level));
    }
    if (!image.levels.empty()) images.push_back(std::move(image));
  }
  return images;
}

const std::vector<Multiscale>& LevelFinder::images_of(const std::string& group) {
  const auto known = images_.find(group);
  if (known != images_.end()) return known->second;
  const auto node = zarr_node(store_, group);
  std::vector<Multiscale>& images = images_[group];
  if (node && !node->array) images = multiscales_in(node->attributes);
  for (Multiscale& image : images) image.document = joined_key(group, node->version == 2 ? ".zattrs" : "zarr.json");
  return images;
}

std::optional<FoundLevel> LevelFinder::find(const std::string& key) {
  std::size_t slash = key.rfind('/');
  while (!key.empty()) {
    const bool root = slash == std::string::npos;
    const std::string path = root ? key : key.substr(slash + 1);
    for (const Multiscale& image : images_of(root ? "" : key.substr(0, slash))) {
      for (std::size_t level = 0; level < image.levels.size(); ++level) {
        if (image.levels[level].path == path) return FoundLevel{image, level};
      }
    }
    if (root) return std::nullopt;
    slash = slash == 0 ? std::string::npos : key.rfind('/', slash - 1);
  }
  return std::nullopt;
}

}  // namespace weir
