#include "daemon/watch/repeated_events.h"

#include <set>
#include <string>
#include <utility>

namespace weir {

std::size_t drop_repeated_events(std::deque<FileEvent>& events, std::size_t first) {
  std::set<std::pair<FileEventKind, std::string>> later;
  std::deque<FileEvent> kept;
  std::size_t kept_first = 0;
  for (std::size_t i = events.size(); i-- > 0;) {
    if (!later.emplace(events[i].kind, events[i].path).second) continue;
    kept.push_front(std::move(events[i]));
    if (i < first) ++kept_first;
  }
  events = std::move(kept);
  return kept_first;
}

}  // namespace weir
