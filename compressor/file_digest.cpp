#include "compressor/file_digest.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <vector>

namespace weir {
namespace {

// Sets pieces[i] to hash(i) for each i in `own`. The file has `bytes` bytes.
template <typename Hash>
void hash_pieces(std::vector<Digest>& pieces, const Share& own, std::uint64_t bytes, const DigestAdvanced& advanced,
                 const Hash& hash) {
  // Pieces between two calls of `advanced`: enough to keep all threads at work.
  const std::int64_t batch = advanced ? 2 * tbb::this_task_arena::max_concurrency() : own.end - own.begin;
  for (std::int64_t begin = own.begin; begin < own.end; begin += batch) {
    const std::int64_t end = std::min(begin + batch, own.end);
    tbb::parallel_for(static_cast<std::size_t>(begin), static_cast<std::size_t>(end),
                      [&](std::size_t i) { pieces[i] = hash(i); });
    if (advanced) advanced(std::min(bytes, static_cast<std::uint64_t>(end - own.begin) * kDigestPieceBytes));
  }
}

}  // namespace

Digest digest_of_file(File& file, Team& team, const DigestAdvanced& advanced) {
  const std::uint64_t bytes = file.size();
  const std::span<const std::byte> memory = file.memory();
  std::vector<Digest> pieces(piece_count(bytes));
  tbb::enumerable_thread_specific<std::vector<std::byte>> scratch{std::vector<std::byte>(kDigestScratchBytes)};
  const Share own = team.share(static_cast<std::int64_t>(pieces.size()));
  team.run([&] {
    hash_pieces(pieces, own, bytes, advanced, [&](std::size_t i) {
      if (memory.size() == bytes) return piece_digest(file_piece(memory, i));
      const std::uint64_t offset = i * kDigestPieceBytes;
      return piece_digest(file, offset, std::min(kDigestPieceBytes, bytes - offset), scratch.local());
    });
  });
  team.gather(pieces);
  return combine(pieces);
}

Digest digest_of_mapping(std::span<const std::byte> file, Trace* trace, const DigestAdvanced& advanced) {
  std::vector<Digest> pieces(piece_count(file.size()));
  const Share all{0, static_cast<std::int64_t>(pieces.size())};
  hash_pieces(pieces, all, file.size(), advanced, [&](std::size_t i) {
    const std::span<const std::byte> piece = file_piece(file, i);
    const TraceSpan span(trace, "hash", piece.size());
    return piece_digest(piece);
  });
  return combine(pieces);
}

}  // namespace weir
