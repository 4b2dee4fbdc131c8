// Coordinates as xarray writes them: arrays of one axis beside the volume, with the names of its axes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ingest/zarr/zarr_source.h"
#include "tests/ingest/zarr/support/zarr_files.h"

namespace weir::zarr_coordinates_test {
namespace {

constexpr std::string_view kGroup = R"({"zarr_format":2})";

/// Array run.zarr/run/T with axes time 2, z 2, lat 3, lon 4. Values: 0, 1, ... at time 0 and 100, 101, ... at time 1.
class ZarrCoordinates : public ::testing::Test {
 protected:
  void SetUp() override {
    files_.write(".zgroup", kGroup);
    files_.write("run/.zgroup", kGroup);
    files_.write("run/T/.zarray", zarray("[2,2,3,4]", "[1,2,3,4]", "|u1", "null"));
    files_.write("run/T/.zattrs", R"({"_ARRAY_DIMENSIONS":["time","z","lat","lon"]})");
    for (std::uint8_t time = 0; time < 2; ++time) {
      std::vector<std::uint8_t> values(24);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(100 * time + i);
      files_.write_values(cat("run/T/", +time, ".0.0.0"), values);
    }
  }
  void write_axis(const std::string& name, const std::vector<double>& values, const std::string& attributes = "{}",
                  const std::string& group = "run") const {
    files_.write(cat(group, "/", name, "/.zarray"),
                 zarray(cat("[", values.size(), "]"), cat("[", values.size(), "]"), "<f8", "null"));
    files_.write(cat(group, "/", name, "/.zattrs"), attributes);
    files_.write_values(cat(group, "/", name, "/0"), values);
  }
  std::unique_ptr<VolumeSource> open(std::int64_t time = 1) const {
    SourceOptions options;
    options.dataset = "run/T";
    options.index = {time};
    return open_source(files_.path(), options);
  }
  SourceInfo info(std::int64_t time = 1) const { return open(time)->info(); }

  ZarrFiles files_;
};

TEST_F(ZarrCoordinates, ThatAreEquallySpaced_GiveSpacingOriginAndUnits) {
  write_axis("z", {10, 20}, R"({"units":"m"})");
  write_axis("lat", {-1, 0.5, 2}, R"({"units":"degrees_north"})");
  write_axis("lon", {100, 101, 102, 103}, R"({"units":"degrees_east"})");
  const SourceInfo found = info();
  EXPECT_EQ(found.spacing, (std::array<double, 3>{1, 1.5, 10}));
  EXPECT_EQ(found.origin, (std::array<double, 3>{100, -1, 10}));
  EXPECT_EQ(found.details.axes[1].units, "degrees_north");
  EXPECT_EQ(found.details.axes[1].note, "");
  EXPECT_EQ(found.details.units_note, "axis x (lon) is in degrees_east, y (lat) in degrees_north, z (z) in m");
  const auto listed = list_zarr(files_.path(), {}).front().attributes;
  EXPECT_EQ(listed.back(), (std::pair<std::string, std::string>{"units of x,y,z", "degrees_east, degrees_north, m"}));
}

TEST_F(ZarrCoordinates, ThatFall_AreReadInReverseOrder) {
  write_axis("lat", {60, 45, 30});
  const auto source = open();
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{1, 15, 1}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{0, 30, 0}));
  EXPECT_EQ(source->info().details.axes[1].note,
            "falls from 60 to 30: rows are read in reverse order, so that positions rise");
  EXPECT_TRUE(source->info().details.axes[1].reversed);
  const std::vector<float> values = ZarrFiles::read_all(*source);
  EXPECT_EQ(std::vector<float>(values.begin(), values.begin() + 12),
            (std::vector<float>{108, 109, 110, 111, 104, 105, 106, 107, 100, 101, 102, 103}));
}

TEST_F(ZarrCoordinates, ThatFall_LeaveTheChunksOfARegionWhereTheyAre) {
  write_axis("lat", {60, 45, 30});
  files_.write("run/T/.zarray", zarray("[2,2,3,4]", "[1,2,1,4]", "|u1", "null"));
  files_.write_values("run/T/0.0.2.0", std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8});
  SourceOptions options;
  options.dataset = "run/T";
  options.index = {0};
  options.roi = VolumeRegion(Box{{0, 0, 0}, {4, 1, 2}});  // the lowest latitude, the last row of the file
  EXPECT_EQ(ZarrFiles::read_all(*open_source(files_.path(), options)), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST_F(ZarrCoordinates, ThatAreIrregular_AreKeptAndSaid) {
  write_axis("lat", {0, 1, 5});
  const SourceInfo found = info();
  EXPECT_EQ(found.spacing[1], 1.0);
  EXPECT_EQ(found.details.axes[1].note, "irregular coordinates from 0 to 5, taken as indices");
  EXPECT_EQ(found.details.axes[1].coordinates, (std::vector<double>{0, 1, 5}));
  const auto listed = list_zarr(files_.path(), {}).front().attributes;
  EXPECT_NE(std::find(listed.begin(), listed.end(),
                      std::pair<std::string, std::string>{"axis y", found.details.axes[1].note}),
            listed.end());
}

TEST_F(ZarrCoordinates, OfATime_SayWhenTheVolumeIs) {
  write_axis("time", {6, 9}, R"({"units":"hours since 2000-01-01","calendar":"noleap"})");
  for (const std::int64_t time : {0, 1}) {
    const auto at = info(time).details.time;
    ASSERT_TRUE(at);
    EXPECT_EQ(at->value, time == 0 ? 6 : 9);
    EXPECT_EQ(at->units, "hours since 2000-01-01");
    EXPECT_EQ(at->calendar, "noleap");
  }
}

TEST_F(ZarrCoordinates, NamedByAnAttribute_SayWhenTheVolumeIs) {
  files_.write("run/T/.zattrs", R"({"_ARRAY_DIMENSIONS":["member","z","lat","lon"],"coordinates":"label valid"})");
  files_.write("run/valid/.zarray", zarray("[]", "[]", "<i8", "0"));
  files_.write("run/valid/.zattrs", R"({"units":"days since 1990-01-01"})");
  files_.write_values("run/valid/0", std::vector<std::int64_t>{17});
  const auto at = info().details.time;
  ASSERT_TRUE(at);
  EXPECT_EQ(at->value, 17);
  EXPECT_EQ(at->units, "days since 1990-01-01");
}

TEST_F(ZarrCoordinates, NamedByAnAttribute_AreLeftOutWhereTheyCannotBeReadOrDoNotFit) {
  files_.write("run/T/.zattrs", R"({"_ARRAY_DIMENSIONS":["time","z","lat","lon"],"coordinates":"bad many valid"})");
  const std::string units = R"({"units":"days since 1990-01-01"})";
  files_.write("run/bad/.zarray", zarray("[]", "[]", "<i8", "0", R"("compressor":{"id":"bz2"},"filters":null)"));
  files_.write("run/bad/.zattrs", units);
  write_axis("many", {1, 2, 3, 4, 5}, units);
  write_axis("valid", {30, 31}, units);
  for (const std::int64_t time : {0, 1}) EXPECT_EQ(info(time).details.time->value, 30 + time);
}

// An xarray store looks like this before its first step is appended.
TEST_F(ZarrCoordinates, OfAnAxisOfNoElements_AreNotLookedAt) {
  files_.write("run/T/.zarray", zarray("[0,2,3,4]", "[1,2,3,4]", "|u1", "null"));
  files_.write("run/time/.zarray", zarray("[0]", "[512]", "<f8", "null"));
  EXPECT_EQ(list_zarr(files_.path(), {})[0].obstacle, "empty: time 0, z 2, lat 3, lon 4");
}

TEST_F(ZarrCoordinates, EqualToTheFillValue_AreNotMissing) {
  files_.write("run/lat/.zarray", zarray("[3]", "[3]", "<i8", "0"));
  files_.write("run/lat/.zattrs", R"({"_ARRAY_DIMENSIONS":["lat"]})");
  files_.write_values("run/lat/0", std::vector<std::int64_t>{0, 10, 20});
  EXPECT_EQ(info().spacing[1], 10);
  write_axis("lat", {0, std::nan(""), 20});
  EXPECT_EQ(info().spacing[1], 1);
  EXPECT_EQ(info().details.axes[1].note, "some of its coordinates are not numbers, taken as indices");
}

TEST_F(ZarrCoordinates, OfAnotherLength_AreNone) {
  write_axis("lat", {5, 6, 7, 8});
  EXPECT_EQ(info().origin, (std::array<double, 3>{}));
}

TEST_F(ZarrCoordinates, AreThoseOfTheNearestGroup) {
  write_axis("lat", {2, 4, 6}, "{}", ".");
  EXPECT_EQ(info().spacing[1], 2);
  write_axis("lat", {3, 6, 9}, "{}", "run");
  EXPECT_EQ(info().spacing[1], 3);
}

TEST_F(ZarrCoordinates, OfAnArrayNamedByItsOwnPath_AreThoseBesideIt) {
  write_axis("lat", {2, 4, 6}, "{}", ".");
  write_axis("lon", {1, 4, 7, 10});
  SourceOptions options;
  options.index = {0};
  EXPECT_EQ(open_source(files_.path("run/T"), options)->info().spacing, (std::array<double, 3>{3, 2, 1}));
}

TEST_F(ZarrCoordinates, ThatCannotBeUnderstood_AreTakenAsIndicesAndThatIsSaid) {
  files_.write("run/lat/.zarray", zarray("[3]", "[3]", "<U4", R"("")"));
  EXPECT_EQ(info().details.axes[1].note.substr(0, 32), "its coordinates cannot be read (");
  write_axis("lat", {3, 6, 9}, R"({"scale_factor":"none"})");
  EXPECT_EQ(info().details.axes[1].note,
            cat("its coordinates cannot be read (", files_.path("run/lat"),
                ": its attribute scale_factor is \"none\" and not one finite number other than 0, so what its values "
                "mean is unknown; correct or remove it), taken as indices"));
  files_.write("run/lat/.zarray", zarray("[3]", "[3000000]", "<f8", "null"));
  EXPECT_EQ(info().details.axes[1].note.substr(0, 32), "its coordinates cannot be read (");
}

TEST_F(ZarrCoordinates, ThatAreDamaged_AreAnError) {
  write_axis("lat", {3, 6, 9});
  files_.write("run/lat/0", "too short");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open(); }).substr(files_.path().size()),
            "/run/lat/0: chunk at 0: holds 9 bytes, not 24; the file is damaged");
}

TEST_F(ZarrCoordinates, OfSeveralChunksInShardsAndPacked_AreRead) {
  files_.write("run/lat/zarr.json", zarr_json("[3]", "[2]", R"([{"name":"bytes","configuration":{"endian":"big"}}])",
                                              "int16", "-1", R"(,"attributes":{"scale_factor":0.5,"add_offset":10})"));
  files_.write("run/lat/c/0", std::string{0, 2, 0, 4});
  files_.write("run/lat/c/1", std::string{0, 6, 0, 0});
  EXPECT_EQ(info().spacing[1], 1);
  EXPECT_EQ(info().origin[1], 11);
  std::filesystem::remove(files_.path("run/lat/c/1"));
  EXPECT_EQ(info().details.axes[1].note, "irregular coordinates from 11 to 9.5, taken as indices");
}

TEST_F(ZarrCoordinates, OfATimeAmongTheLastThree_MakeNoVolume) {
  files_.write("run/rain/.zarray", zarray("[2,3,4]", "[2,3,4]", "|u1", "null"));
  files_.write("run/rain/.zattrs", R"({"_ARRAY_DIMENSIONS":["time","lat","lon"]})");
  files_.write("run/rain/0.0.0", std::string(24, 'a'));
  SourceOptions options;
  options.dataset = "run/rain";
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(files_.path(), options); }),
            files_.path("run/rain") +
                ": 2 axes of space and a time at its end (time 2, lat 3, lon 4); a volume has three of space; to take "
                "the time for a length, give --spacing");
  options.spacing = {1, 1, 1};
  EXPECT_EQ(open_source(files_.path(), options)->info().extent, (Index3{4, 3, 2}));
  // T is the only volume.
  options = {};
  options.index = {0};
  EXPECT_EQ(open_source(files_.path(), options)->info().dataset, "run/T");
}

TEST_F(ZarrCoordinates, OfATimeBehindAnAxisOfSpace_AreRefusedEvenWithASpacing) {
  const std::pair<const char*, const char*> orders[] = {
      {R"("z","time","lat","lon")", "z 2, time 2, lat 3, lon 4"},
      {R"("z","lat","time","lon")", "z 2, lat 2, time 3, lon 4"},
      {R"("z","lat","lon","time")", "z 2, lat 2, lon 3, time 4"},
  };
  SourceOptions options;
  options.dataset = "run/T";
  options.index = {1};
  options.spacing = {1, 1, 1};
  for (const auto& [names, axes] : orders) {
    files_.write("run/T/.zattrs", cat(R"({"_ARRAY_DIMENSIONS":[)", names, "]}"));
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(files_.path(), options); }),
              cat(files_.path("run/T"), ": its time does not come before its axes of space (", axes,
                  "); write it with the time as the first axis"));
  }
}

// xarray writes such a time for a timedelta, and yt for a cosmology.
TEST_F(ZarrCoordinates, OfATimeInAnyUnitButOneOfSpace_MakeNoVolumeAndSayWhenItIs) {
  files_.write("run/rain/.zarray", zarray("[2,3,4]", "[2,3,4]", "|u1", "null"));
  files_.write("run/rain/.zattrs", R"({"_ARRAY_DIMENSIONS":["time","lat","lon"]})");
  files_.write("run/rain/0.0.0", std::string(24, 'a'));
  SourceOptions options;
  options.dataset = "run/rain";
  for (const char* units : {"s", "Myr", "microseconds", "nanoseconds", "weeks", "code_time", "code units", "1"}) {
    write_axis("time", {20, 30}, cat(R"({"units":")", units, R"("})"));
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(files_.path(), options); }),
              files_.path("run/rain") +
                  ": 2 axes of space and a time at its end (time 2, lat 3, lon 4); a volume has three of space; to "
                  "take the time for a length, give --spacing")
        << units;
    for (const std::int64_t time : {0, 1}) {
      const auto at = info(time).details.time;
      ASSERT_TRUE(at) << units;
      EXPECT_EQ(at->value, 20 + 10 * time);
      EXPECT_EQ(at->units, units);
    }
  }
  write_axis("time", {20, 30}, R"({"units":"km"})");
  EXPECT_EQ(open_source(files_.path(), options)->info().spacing, (std::array<double, 3>{1, 1, 10}));
  EXPECT_FALSE(info().details.time);
}

TEST_F(ZarrCoordinates, ThatPointDown_AreKeptAndSaid) {
  write_axis("z", {5, 15}, R"({"positive":"Down","axis":"Z"})");
  const auto source = open(0);
  const std::string said =
      "axis z (z) points down (positive = \"down\"): voxels lie where the file says, upside down where z is up; to "
      "turn them round, negate these coordinates in the file, or reverse the axis where they are irregular";
  EXPECT_EQ(source->info().details.orientation, said);
  EXPECT_EQ(source->info().spacing[2], 10);
  EXPECT_EQ(source->info().origin[2], 5);
  EXPECT_EQ(ZarrFiles::read_all(*source).front(), 0.0F);
  const auto listed = list_zarr(files_.path(), {}).front().attributes;
  EXPECT_NE(std::find(listed.begin(), listed.end(), std::pair<std::string, std::string>{"orientation", said}),
            listed.end());
  // Negated coordinates, as the message advises, turn the voxels round.
  write_axis("z", {-5, -15}, R"({"positive":"up","axis":"Z"})");
  const auto turned = open(0);
  EXPECT_EQ(turned->info().details.orientation, "");
  EXPECT_EQ(turned->info().origin[2], -15);
  EXPECT_EQ(ZarrFiles::read_all(*turned).front(), 12.0F);
}

}  // namespace
}  // namespace weir::zarr_coordinates_test
