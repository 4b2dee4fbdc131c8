#include "compressor/conversion_identity.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <vector>

namespace weir::conversion_identity_test {
namespace {

SourceInfo source() {
  SourceInfo info;
  info.path = "a.raw";
  info.extent = {3, 4, 5};
  return info;
}

TEST(ConversionIdentity, ChangesWithEveryInputThatAffectsTheBytes) {
  const ConversionIdentity one = identify_conversion(source(), {});
  const std::vector<std::function<void(SourceInfo&)>> of_source{
      [](SourceInfo& s) { s.path = "b.raw"; },
      [](SourceInfo& s) { s.file_bytes = 1; },
      [](SourceInfo& s) { s.mtime_ns = 1; },
      [](SourceInfo& s) { s.files_digest = "f"; },
      [](SourceInfo& s) { s.files = {{.path = "a.raw", .exists = true, .inode = 1}}; },
      [](SourceInfo& s) { s.files = {{.path = "a.raw", .exists = true, .ctime_ns = 1}}; },
      [](SourceInfo& s) { s.dataset = "d"; },
      [](SourceInfo& s) {
        s.index = {1, 2};
      },
      [](SourceInfo& s) { s.details.component = "magnitude"; },
      [](SourceInfo& s) { s.details.levels = "up to 2, linear"; },
      [](SourceInfo& s) { s.extent.z = 6; },
      [](SourceInfo& s) { s.index_origin.x = -1; },
      [](SourceInfo& s) { s.type = ScalarType::uint8; },
      [](SourceInfo& s) { s.mapping.scale = 1 + 1e-15; },
      [](SourceInfo& s) { s.mapping.missing = {StoredValue{1.5}}; },
      [](SourceInfo& s) { s.mapping.keeps_missing = true; },
      [](SourceInfo& s) { s.format = "hdf5"; }};
  for (std::size_t i = 0; i < of_source.size(); ++i) {
    SourceInfo changed = source();
    of_source[i](changed);
    EXPECT_NE(identify_conversion(changed, {}), one) << i;
  }
  const std::vector<std::function<void(ConversionOptions&)>> of_options{
      [](ConversionOptions& o) { o.budget.kind = Budget::Kind::rate; },
      [](ConversionOptions& o) { o.budget.rate = 8 + 1e-14; },
      [](ConversionOptions& o) { o.budget.bytes = 1; },
      [](ConversionOptions& o) { o.budget.target = 1; },
      [](ConversionOptions& o) { o.budget.at_most = true; },
      [](ConversionOptions& o) { o.encoding = Encoding::fpn; },
      [](ConversionOptions& o) { o.preview = Preview::off; },
      [](ConversionOptions& o) { o.metric = Metric::median; },
      [](ConversionOptions& o) { o.fill = FillMode::background; },
      [](ConversionOptions& o) { o.brick = 16; },
      [](ConversionOptions& o) {
        o.scene = SceneFile{{}, "s.toml"};
      },
      [](ConversionOptions& o) { o.background = 0.0F; },
      [](ConversionOptions& o) { o.paper_background = true; },
      [](ConversionOptions& o) { o.non_finite = NonFinitePolicy::keep; },
      [](ConversionOptions& o) { o.missing = MissingPolicy::background; },
      [](ConversionOptions& o) { o.provenance.commit = "c"; },
      [](ConversionOptions& o) { o.provenance.version = "v"; },
      [](ConversionOptions& o) {
        o.provenance.options = {{"endian", "big"}};
      }};
  for (std::size_t i = 0; i < of_options.size(); ++i) {
    ConversionOptions changed;
    of_options[i](changed);
    EXPECT_NE(identify_conversion(source(), changed), one) << i;
  }
}

TEST(ConversionIdentity, RelativeAndAbsoluteSourcePathsAreTheSame) {
  SourceInfo absolute = source();
  absolute.path = std::filesystem::current_path() / "a.raw";
  EXPECT_EQ(identify_conversion(source(), {}), identify_conversion(absolute, {}));
  EXPECT_EQ(identify_conversion(source(), {}).at("source"), absolute.path);
}

TEST(ConversionIdentity, SceneValuesCoverVisibilityAndNotTheCamera) {
  const auto with = [](const auto& change) {
    Scene scene;
    change(scene);
    return visible_values(scene);
  };
  EXPECT_EQ(with([](Scene& s) { s.camera.azimuth = 1; }), visible_values({}));
  EXPECT_NE(with([](Scene& s) { s.mode = RenderMode::iso; }), visible_values({}));
  EXPECT_NE(with([](Scene& s) { s.volume.iso = 1; }), visible_values({}));
  EXPECT_NE(with([](Scene& s) { s.volume.range = {0, 1}; }), visible_values({}));
  EXPECT_NE(with([](Scene& s) { s.volume.region = Box{{0, 0, 0}, {1, 1, 1}}; }), visible_values({}));
  EXPECT_NE(with([](Scene& s) { s.volume.opacity = {{0, 1}}; }), visible_values({}));
  Scene opaque;
  opaque.volume.opacity = {{0, 1}};
  EXPECT_NE(scene_digest(opaque), scene_digest({}));
  EXPECT_EQ(scene_digest({}).size(), 32U);
}

TEST(ConversionIdentity, IgnoresOptionsThatDoNotAffectTheBytes) {
  ConversionOptions other;
  other.output = "elsewhere.nvdb";
  other.overwrite = true;
  other.memory = 1;
  other.threads = 7;
  other.work_dir = "/scratch";
  other.resume = Resume::on;
  other.save_interval_s = 0;
  other.backend = CoderChoice::cuda;
  other.certify = Certify::gradient;
  other.provenance.options = {{"memory", "1"},       {"threads", "7"},    {"output", "o"},
                              {"bandwidth", "1"},    {"work-dir", "/s"},  {"direct-io", "on"},
                              {"overwrite", "true"}, {"backend", "cuda"}, {"certify", "gradient"}};
  EXPECT_EQ(identify_conversion(source(), other), identify_conversion(source(), {}));
}

}  // namespace
}  // namespace weir::conversion_identity_test
