// All that one picture of a volume needs but the voxels: camera, light, transfer function and majorants as a scene asks
// for them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "format/nanovdb/macrocells.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/scene.h"
#include "gpu/image/image_output.h"
#include "gpu/render/render_task.h"
#include "gpu/scene/environment.h"
#include "gpu/scene/scene_camera.h"
#include "gpu/scene/transfer_function.h"
#include "gpu/volume/level_choice.h"
#include "gpu/volume/macrocell_grid.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// How coarse a picture may see its volume.
struct LevelOfDetail {
  float bias = 0;       ///< levels above the one whose cubes of voxels are as wide as a pixel
  float scattered = 0;  ///< further levels for rays after a collision; light is then a little off
};

struct RenderOptions {
  std::int32_t width = 960;   ///< pixels
  std::int32_t height = 720;  ///< pixels
  Filter filter = Filter::trilinear;
  std::uint64_t seed = 0;
  std::int64_t cell = kMacrocell;  ///< voxels along a macrocell's edge, at least
  /// Instead of the volume's own, so that all steps of a series look alike.
  std::optional<float> background = std::nullopt;
  /// None: every look-up sees voxels.
  std::optional<LevelOfDetail> levels = std::nullopt;
  /// The scene's; null: loaded from where the scene says. Give it to render the scene again without loading it.
  std::shared_ptr<const Environment> environment = nullptr;
  /// Whose longest edge the scene's density counts along instead of the volume's own, so that an opacity has one
  /// extinction in the world in all steps of a series, whatever their boxes and voxels.
  std::optional<GridFrame> density_frame = std::nullopt;
};

/// What a picture depends on besides the voxels.
struct VolumeInfo {
  GridFrame frame;
  MinMax range{0, 1};    ///< of the values; finite
  float background = 0;  ///< the value that is transparent where a scene gives no opacity
};

/// Of a grid, whose values lie in `cells` where its root names no finite range.
VolumeInfo volume_info(const NvdbGrid& grid, const MacrocellGrid& cells);

/// The levels that a picture can make use of.
struct LevelsUsed {
  LevelChoice choice;
  int finest = 1;  ///< that a look-up may ask for; level 0 are voxels
  float coarsest;  ///< likewise
};

/// What to say of a picture: levels from `first` on are there (0: none), from `wanted` on were of use, up to
/// `coarsest`. Empty where it has what it asked for.
std::string levels_note(int first, int wanted, float coarsest);
/// Whether levels from `first` on change a picture: look-ups mix the voxels with them from one level below on.
bool levels_are_of_use(int first, float coarsest);

/// The colours and opacities that a picture of the scene is made with. Throws Error(usage) for an unknown colormap.
TransferFunction picture_transfer(const VolumeInfo& volume, const Scene& scene, const RenderOptions& options);

/// The value of the surface that a picture shows: the scene's, or one between `background` and the value of `transfer`
/// that is farthest from it.
float picture_iso(const SceneVolume& volume, const TransferFunction& transfer, float background);

/// Extinction at opacity 1, per shortest voxel edge of `frame`: the scene's density, or that of its mode, over the
/// frame's longest edge, or the longest edge of `along`.
float picture_density(const Scene& scene, const GridFrame& frame);
float picture_density(const Scene& scene, const GridFrame& frame, const GridFrame& along);

class RenderSetup {
 public:
  /// `cells` must outlive the object. Throws Error(usage) for an unknown colormap, an impossible camera or a
  /// region outside the volume, and as load_environment.
  RenderSetup(const VolumeInfo& volume, const MacrocellGrid& cells, const Scene& scene, const RenderOptions& options);
  RenderSetup(const RenderSetup&) = delete;
  RenderSetup& operator=(const RenderSetup&) = delete;

  /// The picture of `volume` (see volume_sampler.h), which lies over the same domain. The pointers in it are to
  /// this object, `cells` and the environment.
  template <class Volume>
  RenderTask<Volume> task(const Volume& volume) const {
    RenderTask<Volume> task = bare_task(volume);
    task.medium.cell_opacity = majorants().data();
    return task;
  }
  /// The same without majorants, for callers that compute them elsewhere.
  template <class Volume>
  RenderTask<Volume> bare_task(const Volume& volume) const {
    RenderTask<Volume> task;
    static_cast<RenderFrame&>(task) = frame_;
    static_cast<MediumProperties&>(task.medium) = medium_;
    task.medium.volume = volume;
    return task;
  }

  const TransferFunction& transfer_function() const { return transfer_; }
  /// With host pointers; not present where the scene has none.
  const EnvironmentView& environment() const { return frame_.lighting.environment; }
  ToneMapping tone() const { return tone_; }
  RenderMode mode() const { return frame_.mode; }
  /// None where the options ask for voxels, or all look-ups come near enough to see them.
  const std::optional<LevelsUsed>& levels() const { return levels_; }
  /// For a picture with levels: what rays may see in each of the cells (level_bounds.h).
  void bound_cells(std::vector<MinMax> bounds);

 private:
  const MacrocellGrid& cells() const { return levelled_cells_ ? *levelled_cells_ : cells_; }
  const std::vector<float>& majorants() const;
  std::optional<LevelsUsed> levels_for(const LevelOfDetail& detail) const;
  Box shown(const Scene& scene) const;
  std::vector<Box> framed(const Scene& scene) const;

  Box domain_;
  const MacrocellGrid& cells_;
  std::optional<MacrocellGrid> levelled_cells_;
  TransferFunction transfer_;
  mutable std::vector<float> majorants_;  ///< empty until asked for
  std::shared_ptr<const Environment> environment_;
  MediumProperties medium_;
  RenderFrame frame_;
  ToneMapping tone_;
  std::optional<LevelsUsed> levels_;
};

}  // namespace weir
