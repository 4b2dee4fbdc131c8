// Walks over the survey's rows in pieces of consecutive leaves, on several threads.
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "compressor/survey/row_store.h"

namespace weir {

/// Calls visit(first, rows) for pieces that together cover the leaves [begin, end) by linear index. `rows` are the rows
/// from leaf `first` on. Calls come from several threads at once, in any order. Throws as LeafStore::read.
template <typename Visit>
void for_each_row_piece(const RowStore& store, std::int64_t begin, std::int64_t end, const Visit& visit) {
  constexpr std::int64_t kPiece = 4096;
  tbb::enumerable_thread_specific<std::vector<LeafRow>> pieces;
  tbb::parallel_for(std::int64_t{0}, (end - begin + kPiece - 1) / kPiece, [&](std::int64_t index) {
    const std::int64_t first = begin + index * kPiece;
    const auto rows = static_cast<std::size_t>(std::min(kPiece, end - first));
    if (store.held() != nullptr) return visit(first, std::span(store.held() + first, rows));
    std::vector<LeafRow>& piece = pieces.local();
    piece.resize(rows);
    store.read(first, piece);
    visit(first, std::span<const LeafRow>(piece));
  });
}

}  // namespace weir
