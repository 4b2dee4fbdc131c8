#include "tools/report/input_listing.h"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "format/base/error.h"
#include "format/base/printable.h"
#include "format/base/text.h"
#include "ingest/dataset_pattern.h"
#include "ingest/source/convert_command.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

std::string extents_text(const std::vector<std::int64_t>& extents) {
  std::string text;
  for (const std::int64_t extent : extents) text += cat(text.empty() ? "" : " x ", extent);
  return text.empty() ? "scalar" : text;
}

std::string command_of(const InputListing& listing, const DatasetInfo& dataset) {
  return convert_command(listing.path, listing.container, dataset) + listing.words;
}

}  // namespace

InputListing list_input(const std::string& path, const SourceOptions& options) {
  if (options.stack) return {path, "stack", false, list_single(open_source(path, options)->info(), "")};
  const SourceFormat& format = format_of(path);
  SourceOptions without_dataset = options;  // keep_named() reports a dataset that does not exist
  without_dataset.dataset.clear();
  refuse_foreign_options(path, format, without_dataset);
  SourceOptions all = options;
  all.lists_damaged = true;
  return {path, std::string(format.name), format.container, format.list(path, all)};
}

void keep_named(InputListing& listing, const std::string& dataset) {
  constexpr std::size_t kMostNames = 8;
  std::string names;
  for (std::size_t i = 0; i < std::min(listing.datasets.size(), kMostNames); ++i) {
    names += cat(i == 0 ? "" : ", ", listing.datasets[i].name);
  }
  if (listing.datasets.size() > kMostNames) names += cat(" and ", listing.datasets.size() - kMostNames, " more");
  const bool nameless = listing.datasets.size() == 1 && names.empty();
  std::erase_if(listing.datasets, [&](const DatasetInfo& info) { return !names_dataset(dataset, info.name); });
  if (!listing.datasets.empty()) return;
  throw Error(ErrorKind::usage,
              compose(listing.path, ": lists no dataset for ", option("dataset", dataset), "; it has ",
                      nameless        ? "one volume without a name"
                      : names.empty() ? "none"
                                      : names));
}

void print_text(const InputListing& listing) {
  std::cout << cat(printable(listing.path), ": ", listing.format, ", ", listing.datasets.size(),
                   listing.datasets.size() == 1 ? " volume\n" : " datasets\n");
  for (const DatasetInfo& dataset : listing.datasets) {
    const std::string what = dataset.type.empty() ? "not read" : cat(extents_text(dataset.extents), ' ', dataset.type);
    std::cout << cat('\n', dataset.name.empty() ? "" : printable(dataset.name) + ": ", what,
                     dataset.layout.empty() ? "" : ", ", dataset.layout, '\n');
    for (const auto& [name, value] : dataset.attributes) {
      std::cout << cat("  ", printable(name), ": ", printable(value), '\n');
    }
    if (!dataset.obstacle.empty()) {
      std::cout << cat("  cannot be converted: ", printable(dataset.obstacle), '\n');
      continue;
    }
    std::cout << cat("  ", printable(command_of(listing, dataset)), '\n');
  }
}

nlohmann::ordered_json to_json(const InputListing& listing) {
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
                        {"components", dataset.components},
                        {"obstacle", dataset.obstacle.empty() ? Json() : Json(dataset.obstacle)},
                        {"command", dataset.obstacle.empty() ? Json(command_of(listing, dataset)) : Json()}});
  }
  return {{"path", listing.path}, {"format", listing.format}, {"datasets", datasets}};
}

}  // namespace weir
