#include "tools/report/input_listing.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "format/base/text.h"
#include "tools/report/printable.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

// As one word of a POSIX shell.
std::string quoted(const std::string& text) {
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

std::string extents_text(const std::vector<std::int64_t>& extents) {
  std::string text;
  for (const std::int64_t extent : extents) text += cat(text.empty() ? "" : " x ", extent);
  return text.empty() ? "scalar" : text;
}

void print_text(const InputListing& listing) {
  std::cout << cat(printable(listing.path), ": ", listing.format, ", ", listing.datasets.size(),
                   listing.datasets.size() == 1 ? " volume\n" : " datasets\n");
  for (const DatasetInfo& dataset : listing.datasets) {
    std::cout << cat('\n', dataset.name.empty() ? "" : printable(dataset.name) + ": ", extents_text(dataset.extents),
                     ' ', dataset.type, dataset.layout.empty() ? "" : ", ", dataset.layout, '\n');
    for (const auto& [name, value] : dataset.attributes) {
      std::cout << cat("  ", printable(name), ": ", printable(value), '\n');
    }
    if (!dataset.obstacle.empty()) {
      std::cout << cat("  cannot be converted: ", printable(dataset.obstacle), '\n');
      continue;
    }
    std::cout << cat("  ", printable(convert_command(listing, dataset)), '\n');
  }
}

void print_json(const InputListing& listing) {
  Json datasets = Json::array();
  for (const DatasetInfo& dataset : listing.datasets) {
    Json attributes = Json::object();
    for (const auto& [name, value] : dataset.attributes) attributes[name] = value;
    datasets.push_back({{"name", dataset.name},
                        {"extents", dataset.extents},
                        {"type", dataset.type},
                        {"layout", dataset.layout},
                        {"attributes", attributes},
                        {"leading_axes", dataset.leading_axes},
                        {"obstacle", dataset.obstacle.empty() ? Json() : Json(dataset.obstacle)},
                        {"command", dataset.obstacle.empty() ? Json(convert_command(listing, dataset)) : Json()}});
  }
  const Json report{{"path", listing.path}, {"format", listing.format}, {"datasets", datasets}};
  std::cout << report.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace

InputListing list_input(const std::string& path, const SourceOptions& options) {
  const SourceFormat& format = format_of(path);
  return {path, std::string(format.name), format.container, format.list(path, options)};
}

std::string convert_command(const InputListing& listing, const DatasetInfo& dataset) {
  std::string command = cat("weir convert ", quoted(listing.path));
  if (listing.container && !dataset.name.empty()) command += cat(" --dataset ", quoted(dataset.name));
  for (std::size_t i = 0; i < dataset.leading_axes; ++i) command += i == 0 ? " --index 0" : ",0";
  return command;
}

void print_listing(const InputListing& listing, bool json) { json ? print_json(listing) : print_text(listing); }

}  // namespace weir
