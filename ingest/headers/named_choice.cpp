#include "ingest/headers/named_choice.h"

#include <algorithm>
#include <vector>

#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::size_t kMostShown = 20;
constexpr std::size_t kMostChoicesShown = 8;

// Returns text such as "'density', 'heat' and 3 more".
std::string names_text(std::span<const NamedVolume> there, std::span<const std::size_t> which) {
  std::string text;
  for (std::size_t i = 0; i < std::min(which.size(), kMostShown); ++i) {
    text += cat(i == 0 ? "" : ", ", in_quotes(there[which[i]].name));
  }
  if (which.size() > kMostShown) text += cat(" and ", which.size() - kMostShown, " more");
  return text;
}

std::string article(std::string_view kind) { return kind.starts_with('a') ? cat("an ", kind) : cat("a ", kind); }

}  // namespace

std::size_t choose_volume(const std::string& path, std::string_view kind, std::span<const NamedVolume> there,
                          const std::string& wanted) {
  std::vector<std::size_t> all;
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < there.size(); ++i) {
    all.push_back(i);
    if (there[i].obstacle.empty()) usable.push_back(i);
  }
  if (all.empty()) throw Error(ErrorKind::input, cat(path, ": holds no ", kind));

  if (!wanted.empty()) {
    const auto found = std::find_if(there.begin(), there.end(), [&](const auto& v) { return v.name == wanted; });
    if (found == there.end()) {
      throw Error(ErrorKind::input,
                  cat(path, ": has no ", kind, ' ', in_quotes(wanted), "; it has ", names_text(there, all)));
    }
    if (!found->obstacle.empty()) {
      throw Error(ErrorKind::input,
                  cat(path, ": ", kind, ' ', in_quotes(wanted), " cannot be converted: ", found->obstacle));
    }
    return static_cast<std::size_t>(found - there.begin());
  }
  if (usable.size() == 1) return usable.front();
  if (usable.empty()) {
    throw Error(ErrorKind::input, cat(path, ": holds no ", kind, " that can be converted; ",
                                      in_quotes(there.front().name), ": ", there.front().obstacle));
  }
  throw Error(ErrorKind::usage, compose(path, ": holds ", usable.size(), ' ', kind, "s that can be converted; name ",
                                        article(kind), " with ", option("dataset"), ": ", names_text(there, usable)));
}

Error several_volumes(const std::string& path, std::string_view kind, std::size_t count,
                      std::span<const Message> choices) {
  Message text;
  const std::size_t shown = std::min(choices.size(), kMostChoicesShown);
  for (std::size_t i = 0; i < shown; ++i) text += compose(i == 0 ? "" : "; ", choices[i]);
  if (count > shown) text += cat("; and ", count - shown, " more (weir inspect lists them)");
  return usage_error(compose(path, ": holds ", count, ' ', kind, "; choose one with ", option("dataset"), ": ", text));
}

}  // namespace weir
