#include "gpu/render/render_scene.h"

namespace weir {

RenderScene::RenderScene(const NvdbGrid& grid, const Scene& scene, const RenderOptions& options)
    : table_(grid),
      cells_(grid, options.cell),
      setup_(volume_info(grid, cells_), cells_, scene, options),
      task_(setup_.task(VolumeSampler{table_.view(), options.filter})) {}

}  // namespace weir
