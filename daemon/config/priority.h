// Which of a watch's sources comes first.
#pragma once

namespace weir {

enum class Priority { newest, oldest };  ///< by modification time

}  // namespace weir
