#include "compressor/file_digest.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace weir {

Digest digest_of_file(File& file, Team& team, const std::function<void(std::uint64_t)>& advanced) {
  constexpr std::int64_t kBatch = 32;  // pieces between two calls of `advanced`
  const std::uint64_t bytes = file.size();
  std::vector<Digest> pieces(piece_count(bytes));
  tbb::enumerable_thread_specific<std::vector<std::byte>> scratch{std::vector<std::byte>(kDigestScratchBytes)};
  const Share own = team.share(static_cast<std::int64_t>(pieces.size()));
  team.run([&] {
    for (std::int64_t begin = own.begin; begin < own.end; begin += kBatch) {
      const std::int64_t end = std::min(begin + kBatch, own.end);
      tbb::parallel_for(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), [&](std::size_t i) {
        const std::uint64_t offset = i * kDigestPieceBytes;
        pieces[i] = piece_digest(file, offset, std::min(kDigestPieceBytes, bytes - offset), scratch.local());
      });
      if (advanced) advanced(std::min(bytes, static_cast<std::uint64_t>(end - own.begin) * kDigestPieceBytes));
    }
  });
  team.gather(pieces);
  return combine(pieces);
}

}  // namespace weir
