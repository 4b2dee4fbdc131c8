#include "compressor/team/team.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <string>

#include "format/base/error.h"

namespace weir {
namespace {

class NoTeam final : public Team {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  void merge(Bytes&, const Merge&) override {}
};

// Returns an error as bytes: its kind, then its message. The message stays packed, so that each process names options
// in the way that its own user knows.
Team::Bytes failure_bytes(const Error& error) {
  const std::string text = error.message().packed();
  Team::Bytes bytes(1 + text.size());
  bytes.front() = static_cast<std::byte>(error.kind());
  std::memcpy(bytes.data() + 1, text.data(), text.size());
  return bytes;
}

Error error_of(const Team::Bytes& bytes) {
  const auto* text = reinterpret_cast<const char*>(bytes.data() + 1);
  return {static_cast<ErrorKind>(bytes.front()), Message::unpack({text, bytes.size() - 1})};
}

}  // namespace

Share Team::share(std::int64_t count) const {
  const std::int64_t ranks = size();
  const std::int64_t least = count / ranks;
  const std::int64_t more = count % ranks;
  const auto begin = [&](std::int64_t rank) { return rank * least + std::min(rank, more); };
  return {begin(rank()), begin(rank() + 1)};
}

void Team::run(const std::function<void()>& work) {
  if (alone()) return work();
  Bytes failure;
  try {
    work();
  } catch (const Error& error) {
    failure = failure_bytes(error);
  } catch (const std::exception& error) {
    failure = failure_bytes(Error(ErrorKind::internal, error.what()));
  }
  merge(failure, [](Bytes& lower, const Bytes& higher) {
    if (lower.empty()) lower = higher;
  });
  if (!failure.empty()) throw error_of(failure);
}

void Team::lead(const std::function<void()>& work) {
  run([&] {
    if (leads()) work();
  });
}

void Team::publish(File& file) {
  if (alone()) return;
  run([&] { file.sync(); });
  run([&] { file.sync(); });  // makes what other ranks wrote visible here
}

Team& no_team() {
  static NoTeam team;
  return team;
}

}  // namespace weir
