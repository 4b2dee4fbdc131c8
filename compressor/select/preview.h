// The choice whether programs other than weir see a preview in a packed file.
#pragma once

namespace weir {

/// Whether the tree of a packed file holds each block's mean, which other programs read. automatic: if the means take
/// at most a tenth of the file.
enum class Preview { automatic, on, off };

/// With Preview::automatic, a file with a preview is at least this many times as long as the preview.
inline constexpr unsigned kLeastOfPreview = 10;

}  // namespace weir
