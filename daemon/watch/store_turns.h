// Limits how many Zarr hierarchies are looked through at once. Between its parts, a look holds a directory open for
// each level, and there may be more hierarchies than the process may open files.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace weir {

/// Gives a few turns at a time, in the order of the requests. One thread.
class StoreTurns {
 public:
  /// `turn` is called with the head of a hierarchy when it gets its turn. The call comes from within take() and
  /// give_back(), also those of other hierarchies.
  StoreTurns(std::size_t at_once, std::function<void(const std::string& head)> turn)
      : at_once_(at_once), turn_(std::move(turn)) {}

  /// Returns whether `head` has its turn now, until it is given back. If not, `head` waits for its turn.
  bool take(const std::string& head);
  /// Gives the turn back, or stops waiting for it.
  void give_back(const std::string& head);

 private:
  void let_in();

  std::size_t at_once_;
  std::function<void(const std::string& head)> turn_;
  std::set<std::string> looking_;
  std::set<std::string> waiting_;
  std::deque<std::string> order_;  ///< heads in the order of their requests; some of them may not wait any more
};

/// The turn of one hierarchy, given back on destruction.
class StoreTurn {
 public:
  /// Without StoreTurns, take() always returns true.
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
