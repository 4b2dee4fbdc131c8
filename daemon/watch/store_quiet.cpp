#include "daemon/watch/store_quiet.h"

#include <algorithm>
#include <utility>

#include "format/base/text.h"
#include "ingest/files/input_directory.h"

namespace weir {
namespace {

constexpr std::chrono::seconds kQueued{10};  // a hierarchy is told when its turn comes; this limit is for a lost notice

bool names_store(std::string_view component) { return component.size() > 5 && component.ends_with(".zarr"); }

std::string_view directory_of_path(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
}

std::string_view last_of(std::string_view path) { return path.substr(path.find_last_of('/') + 1); }

}  // namespace

bool is_in_store(std::string_view path) {
  for (std::string_view directory = directory_of_path(path); !directory.empty();
       directory = directory_of_path(directory)) {
    if (names_store(last_of(directory))) return true;
  }
  return false;
}

bool is_store_head(std::string_view path) {
  if (!is_head(path) || is_plotfile_head(path)) return false;
  const std::string_view store = named_by_head(path);
  return names_store(last_of(store)) && !is_in_store(store);
}

StoreQuiet::Answer StoreQuiet::look(Time now) {
  const auto pause =
      std::chrono::duration_cast<Time::duration>(std::max<std::chrono::nanoseconds>(settle_, kLeastPause));
  if (!look_) {
    if (!turn_.take())
      return {false, now + std::max<Time::duration>(pause, kQueued), "others are looked through before"};
    look_.emplace(directory_);
    begun_ = now;
  }
  if (look_->step()) return {false, now, cat("its files are looked through, ", look_->found().files, " so far")};
  const StoreLook::Found found = look_->found();
  std::string fault = look_->fault();
  stop();
  if (!fault.empty()) {  // the unseen part may be the one that changes
    before_.reset();
    return {false, now + pause, std::move(fault)};
  }
  const bool same = before_ == found;
  const bool long_enough = same && begun_ - before_end_ >= pause;
  if (long_enough) return {true, {}, {}};
  const bool first = !before_;
  if (!same) {
    before_ = found;
    before_end_ = now;
  }
  return {false, before_end_ + pause,
          cat("it has ", found.files, " files, ", format_bytes(found.bytes),
              first ? ", and may still be written" : ", and changed a moment ago")};
}

void StoreQuiet::stop() {
  look_.reset();
  turn_.give_back();
}

}  // namespace weir
