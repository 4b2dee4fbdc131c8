#include "daemon/watch/store_turns.h"

namespace weir {

bool StoreTurns::take(const std::string& head) {
  if (looking_.contains(head)) return true;
  if (waiting_.insert(head).second) order_.push_back(head);
  let_in();
  return looking_.contains(head);
}

void StoreTurns::give_back(const std::string& head) {
  const bool looked = looking_.erase(head) > 0;
  waiting_.erase(head);
  if (looked) let_in();
}

void StoreTurns::let_in() {
  while (looking_.size() < at_once_ && !order_.empty()) {
    const std::string head = std::move(order_.front());
    order_.pop_front();
    if (waiting_.erase(head) == 0) continue;
    looking_.insert(head);
    turn_(head);
  }
}

}  // namespace weir
