// The processes that convert one volume together. Each process calls the same functions in the same order, does its
// share of the work in them, and at the end knows what all processes found. So the bytes do not depend on the number of
// processes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "format/io/file_system.h"

namespace weir {

/// Items [begin, end) of a sequence.
struct Share {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

/// In each rank, one thread at a time makes the calls that concern all ranks. They throw Error(io) if another process
/// cannot be reached.
class Team {
 public:
  using Bytes = std::vector<std::byte>;
  /// Adds the part of a higher rank to the part of a lower rank.
  using Merge = std::function<void(Bytes& lower, const Bytes& higher)>;

  virtual ~Team() = default;
  virtual int rank() const = 0;  ///< 0 to size() - 1
  virtual int size() const = 0;
  /// Merges the parts of all ranks in the order of ranks. Afterwards `part` holds the merged result on every rank.
  virtual void merge(Bytes& part, const Merge& both) = 0;

  bool alone() const { return size() == 1; }
  /// Returns whether this rank does the work that one process must do for all.
  bool leads() const { return rank() == 0; }
  /// Returns this rank's part of `count` items. Parts differ by at most one item and follow each other in rank order.
  Share share(std::int64_t count) const;

  /// Does `work`, which concerns this rank alone, and returns when all ranks have finished theirs. If `work` throws on
  /// any rank, throws the Error of the lowest such rank on all ranks.
  void run(const std::function<void()>& work);
  /// Does `work` on the leading rank alone; otherwise as run().
  void lead(const std::function<void()>& work);

  /// Makes everything that any rank wrote to `file` before the call readable for every rank after the call.
  void publish(File& file);

  /// Sums the values of all ranks element by element, with +=. All ranks must give the same number of values.
  template <typename T>
  void sum(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (alone()) return;
    Bytes part = bytes_of<T>(values);
    merge(part, [](Bytes& lower, const Bytes& higher) {
      for (std::size_t at = 0; at < lower.size(); at += sizeof(T)) {
        T sum;
        T term;
        std::memcpy(&sum, lower.data() + at, sizeof(T));
        std::memcpy(&term, higher.data() + at, sizeof(T));
        sum += term;
        std::memcpy(lower.data() + at, &sum, sizeof(T));
      }
    });
    std::memcpy(values.data(), part.data(), part.size());
  }

  /// Sets `items` to the items of all ranks, the items of lower ranks first.
  template <typename T>
  void concatenate(std::vector<T>& items) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (alone()) return;
    Bytes part = bytes_of<T>(items);
    merge(part, append);
    items.resize(part.size() / sizeof(T));
    if (!part.empty()) std::memcpy(items.data(), part.data(), part.size());
  }

  /// Fills in the shares of the other ranks in `items`. Each rank has set its own share().
  template <typename T>
  void gather(std::vector<T>& items) {
    if (alone()) return;
    const Share own = share(static_cast<std::int64_t>(items.size()));
    items = std::vector<T>(items.begin() + own.begin, items.begin() + own.end);
    concatenate(items);
  }

  /// Copies the items of the leading rank to all ranks.
  template <typename T>
  void follow(std::vector<T>& items) {
    if (alone()) return;
    if (!leads()) items.clear();
    concatenate(items);
  }
  template <typename T>
  void follow(T& item) {
    struct One {
      T value;
    };
    std::vector<One> one{{item}};
    follow(one);
    item = one.front().value;
  }

 private:
  template <typename T>
  static Bytes bytes_of(std::span<const T> items) {
    const std::span<const std::byte> bytes = std::as_bytes(items);
    return {bytes.begin(), bytes.end()};
  }
  static void append(Bytes& lower, const Bytes& higher) { lower.insert(lower.end(), higher.begin(), higher.end()); }
};

/// Returns a team that consists of this process alone.
Team& no_team();

}  // namespace weir
