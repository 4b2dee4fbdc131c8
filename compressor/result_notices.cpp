#include "compressor/result_notices.h"

#include "compressor/default_notice.h"
#include "compressor/scene_notice.h"

namespace weir {

void say_result(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice) {
  if (!notice) return;
  if (const Message line = scene_notice(sidecar, options.output); !line.empty()) notice(line);
  if (options.budget.kind != Budget::Kind::automatic) return;
  if (const Message line = default_notice(sidecar, options.output); !line.empty()) notice(line);
}

}  // namespace weir
