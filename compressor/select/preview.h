// The choice of what programs other than weir see in a packed file.
#pragma once

namespace weir {

/// Whether the tree of a packed file holds each block's mean, which is what other programs read. automatic: where that
/// takes at most a tenth of the file.
enum class Preview { automatic, on, off };

/// With Preview::automatic, a file is at least that many times as long as its preview.
inline constexpr unsigned kLeastOfPreview = 10;

}  // namespace weir
