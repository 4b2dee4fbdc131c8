// Turns at looking through Zarr hierarchies: a look holds a directory open for each level between its parts, and there
// may be more hierarchies than the process may open files.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace weir {

/// A few at a time, in the order they ask. One thread.
class StoreTurns {
 public:
  /// `turn` is called with the head of a hierarchy that has waited, when it is its turn: from within take() and
  /// give_back() of others.
  StoreTurns(std::size_t at_once, std::function<void(const std::string& head)> turn)
      : at_once_(at_once), turn_(std::move(turn)) {}

  /// Whether it is its turn now, until it is given back; else it waits for it.
  bool take(const std::string& head);
  /// Gives the turn back, or waits for it no more.
  void give_back(const std::string& head);

 private:
  void let_in();

  std::size_t at_once_;
  std::function<void(const std::string& head)> turn_;
  std::set<std::string> looking_;
  std::set<std::string> waiting_;
  std::deque<std::string> order_;  ///< of the waiting ones; some may wait no more
};

/// The turn of one hierarchy, given back on destruction.
class StoreTurn {
 public:
  /// Always its turn.
  StoreTurn() = default;
  StoreTurn(std::weak_ptr<StoreTurns> turns, std::string head) : turns_(std::move(turns)), head_(std::move(head)) {}
  StoreTurn(StoreTurn&& other) noexcept = default;
  StoreTurn& operator=(StoreTurn&&) = delete;
  ~StoreTurn() { give_back(); }

  bool take() {
    const auto turns = turns_.lock();
    return turns == nullptr || turns->take(head_);
  }
  void give_back() {
    if (const auto turns = turns_.lock()) turns->give_back(head_);
  }

 private:
  std::weak_ptr<StoreTurns> turns_;
  std::string head_;
};

}  // namespace weir
