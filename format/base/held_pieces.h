// Keeps used pieces of memory for the next user that needs some.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

namespace weir {

template <class Piece>
class HeldPieces {
 public:
  /// Takes the smallest piece of at least `bytes` and at most most_times * bytes for which suits(piece) holds; nullopt
  /// if there is none.
  template <class Suits>
  std::optional<Piece> take(std::size_t bytes, std::size_t most_times, const Suits& suits) {
    auto best = pieces_.end();
    for (auto held = pieces_.begin(); held != pieces_.end(); ++held) {
      if (held->bytes < bytes || held->bytes > most_times * bytes || !suits(held->piece)) continue;
      if (best == pieces_.end() || held->bytes < best->bytes) best = held;
    }
    return best == pieces_.end() ? std::nullopt : take(best);
  }
  /// Takes the piece that was added first; nullopt if there is none.
  std::optional<Piece> take_oldest() { return pieces_.empty() ? std::nullopt : take(pieces_.begin()); }
  /// Throws std::bad_alloc; `piece` is destroyed then.
  void add(std::size_t bytes, Piece piece) {
    pieces_.push_back({bytes, std::move(piece)});
    bytes_ += bytes;
  }
  /// Returns the bytes of all pieces together.
  std::size_t bytes() const { return bytes_; }

 private:
  struct Held {
    std::size_t bytes;
    Piece piece;
  };
  std::optional<Piece> take(typename std::deque<Held>::iterator held) {
    std::optional<Piece> taken(std::move(held->piece));
    bytes_ -= held->bytes;
    pieces_.erase(held);
    return taken;
  }

  std::deque<Held> pieces_;  // the oldest first
  std::size_t bytes_ = 0;
};

}  // namespace weir
