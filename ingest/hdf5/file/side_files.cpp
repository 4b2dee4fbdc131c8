#include "ingest/hdf5/file/side_files.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace weir {

std::vector<std::string> side_file_places(const std::string& name, const std::string& parent,
                                          const char* prefix_variable) {
  const std::filesystem::path file(name);
  if (file.is_absolute()) return {name};
  const std::filesystem::path beside = std::filesystem::path(parent).parent_path();
  std::vector<std::string> places;
  if (const char* const set = std::getenv(prefix_variable); set != nullptr && *set != '\0') {
    constexpr std::string_view kOrigin = "${ORIGIN}";
    std::string prefix(set);
    if (prefix.starts_with(kOrigin)) prefix.replace(0, kOrigin.size(), beside.empty() ? "." : beside.string());
    places.push_back((std::filesystem::path(prefix) / file).string());
  }
  places.push_back((beside / file).string());
  if (!beside.empty()) places.push_back(name);
  return places;
}

std::optional<std::string> find_side_file(const std::string& name, const std::string& parent,
                                          const char* prefix_variable) {
  const std::vector<std::string> places = side_file_places(name, parent, prefix_variable);
  const auto found = std::ranges::find_if(places, [](const std::string& place) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(place, ignored);
  });
  if (found == places.end()) return std::nullopt;
  return *found;
}

}  // namespace weir
