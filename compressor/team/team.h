// The processes that convert one volume together. Each calls the same functions
// in the same order, does its share of the work in them, and knows in the end
// what all of them found; so the bytes do not depend on how many there are.
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

/// The calls that concern all ranks are made by one thread of each at a time. Throws Error(io) where another process is
/// out of reach.
class Team {
 public:
  using Bytes = std::vector<std::byte>;
  /// Adds the parts of higher ranks to those of lower ones.
  using Merge = std::function<void(Bytes& lower, const Bytes& higher)>;

  virtual ~Team() = default;
  virtual int rank() const = 0;  ///< 0 to size() - 1
  virtual int size() const = 0;
  /// What the parts of all ranks come to, merged in the order of ranks, takes the place of `part` on each of them.
  virtual void merge(Bytes& part, const Merge& both) = 0;

  bool alone() const { return size() == 1; }
  /// Does what one process must do for all.
  bool leads() const { return rank() == 0; }
  /// This rank's part of `count` items: parts differ by one item at most, and follow each other as the ranks do.
  Share share(std::int64_t count) const;

  /// Does `work`, which concerns this rank alone. Where it throws on any rank, the Error of the lowest such rank is
  /// thrown on all of them. When it returns, all ranks have returned from theirs.
  void run(const std::function<void()>& work);
  /// The same for what the leading rank does alone.
  void lead(const std::function<void()>& work);

  /// What any rank wrote to `file` before, every rank reads afterwards.
  void publish(File& file);

  /// Sums by element, by +=; all ranks give as many.
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

  /// The items of all ranks, those of lower ranks first.
  template <typename T>
  void concatenate(std::vector<T>& items) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (alone()) return;
    Bytes part = bytes_of<T>(items);
    merge(part, append);
    items.resize(part.size() / sizeof(T));
    if (!part.empty()) std::memcpy(items.data(), part.data(), part.size());
  }

  /// Each rank's share of `items` is its own; the others' are filled in.
  template <typename T>
  void gather(std::vector<T>& items) {
    if (alone()) return;
    const Share own = share(static_cast<std::int64_t>(items.size()));
    items = std::vector<T>(items.begin() + own.begin, items.begin() + own.end);
    concatenate(items);
  }

  /// What the leading rank has becomes everyone's.
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

/// A team of this process alone.
Team& no_team();

}  // namespace weir
