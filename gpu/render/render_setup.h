// All that one picture of a volume needs except the voxels: camera, light, transfer function and majorants, as a
// scene asks for them.
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

/// How coarsely a picture may sample its volume.
struct LevelOfDetail {
  float bias = 0;       ///< levels added to the level at which a cube of voxels is as wide as a pixel
  float scattered = 0;  ///< levels added further for rays after a collision; the light is then slightly inexact
};

struct RenderOptions {
  std::int32_t width = 960;   ///< pixels
  std::int32_t height = 720;  ///< pixels
  Filter filter = Filter::trilinear;
  std::uint64_t seed = 0;
  std::int64_t cell = kMacrocell;  ///< least number of voxels along a macrocell's edge
  /// Replaces the volume's own background, so that all steps of a series look alike.
  std::optional<float> background = std::nullopt;
  /// If empty, every look-up reads voxels.
  std::optional<LevelOfDetail> levels = std::nullopt;
  /// The scene's environment. If null, it is loaded from the path in the scene. Pass it to render the scene again
  /// without loading it again.
  std::shared_ptr<const Environment> environment = nullptr;
  /// The frame that gives the scene's density its longest edge, instead of the volume's own frame. With it, an
  /// opacity has the same extinction in the world in all steps of a series, whatever their boxes and voxel sizes.
  std::optional<GridFrame> density_frame = std::nullopt;
};

/// What a picture depends on besides the voxels.
struct VolumeInfo {
  GridFrame frame;
  MinMax range{0, 1};    ///< range of the values; finite
  float background = 0;  ///< the value that is transparent if a scene gives no opacity
};

/// Returns the description of a grid. The value range comes from `cells` if the grid's root names no finite range.
VolumeInfo volume_info(const NvdbGrid& grid, const MacrocellGrid& cells);

/// The levels that a picture can make use of.
struct LevelsUsed {
  LevelChoice choice;
  int finest = 1;  ///< finest level that a look-up may ask for; level 0 is the voxels
  float coarsest;  ///< coarsest level that a look-up may ask for
};

/// Returns a note for a picture that lacks levels it asked for, otherwise an empty text. Levels from `first` on exist
/// (0: none); levels from `wanted` on, up to `coarsest`, would be used.
std::string levels_note(int first, int wanted, float coarsest);
/// Returns whether levels from `first` on change a picture. A look-up mixes voxels with level `first` as soon as it
/// asks for more than level `first` - 1.
bool levels_are_of_use(int first, float coarsest);

/// Returns the colours and opacities of a picture of the scene. Throws Error(usage) for an unknown colormap.
TransferFunction picture_transfer(const VolumeInfo& volume, const Scene& scene, const RenderOptions& options);

/// Returns the value of the surface that a picture shows: the scene's value, or a value between `background` and the
/// end of `transfer`'s range that is farther from it.
float picture_iso(const SceneVolume& volume, const TransferFunction& transfer, float background);

/// Returns the extinction at opacity 1, per shortest voxel edge of `frame`. It is the density of the scene, or the
/// default of its mode, divided by the longest edge of `frame` or of `along`.
float picture_density(const Scene& scene, const GridFrame& frame);
float picture_density(const Scene& scene, const GridFrame& frame, const GridFrame& along);

class RenderSetup {
 public:
  /// `cells` must outlive the object. Throws Error(usage) for an unknown colormap, an impossible camera or a region
  /// outside the volume, and the errors of load_environment.
  RenderSetup(const VolumeInfo& volume, const MacrocellGrid& cells, const Scene& scene, const RenderOptions& options);
  RenderSetup(const RenderSetup&) = delete;
  RenderSetup& operator=(const RenderSetup&) = delete;

  /// Returns the task that draws `volume` (see volume_sampler.h), which covers the same domain. The task points into
  /// this object, `cells` and the environment.
  template <class Volume>
  RenderTask<Volume> task(const Volume& volume) const {
    RenderTask<Volume> task = bare_task(volume);
    task.medium.cell_opacity = majorants().data();
    return task;
  }
  /// Returns the same task without majorants, for callers that compute the majorants elsewhere.
  template <class Volume>
  RenderTask<Volume> bare_task(const Volume& volume) const {
    RenderTask<Volume> task;
    static_cast<RenderFrame&>(task) = frame_;
    static_cast<MediumProperties&>(task.medium) = medium_;
    task.medium.volume = volume;
    return task;
  }

  const TransferFunction& transfer_function() const { return transfer_; }
  /// Returns the environment with host pointers. It is not present if the scene has none.
  const EnvironmentView& environment() const { return frame_.lighting.environment; }
  ToneMapping tone() const { return tone_; }
  RenderMode mode() const { return frame_.mode; }
  /// Returns no levels if the options ask for voxels, or if every look-up is so near that it reads voxels.
  const std::optional<LevelsUsed>& levels() const { return levels_; }
  /// For a picture with levels: sets the bounds of the values that rays may read in each cell (level_bounds.h).
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
  mutable std::vector<float> majorants_;  ///< empty until majorants() is called
  std::shared_ptr<const Environment> environment_;
  MediumProperties medium_;
  RenderFrame frame_;
  ToneMapping tone_;
  std::optional<LevelsUsed> levels_;
};

}  // namespace weir
