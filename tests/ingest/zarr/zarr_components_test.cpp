// Arrays of vectors: which component is read, however chunks cut the arrays.
#include <cmath>

#include "ingest/source/convert_command.h"
#include "ingest/zarr/zarr_source.h"
#include "tests/ingest/zarr/support/zarr_files.h"

namespace weir::zarr_components_test {
namespace {

using Extents = std::array<std::int64_t, 4>;

constexpr ComponentChoice kMagnitude{true, 0};
constexpr std::int64_t kX = 4;
constexpr std::int64_t kY = 3;
constexpr std::int64_t kZ = 2;
constexpr std::int64_t kComponents = 3;
constexpr Extents kShape{kZ, kY, kX, kComponents};

std::string list_text(const Extents& extents) {
  return cat('[', extents[0], ',', extents[1], ',', extents[2], ',', extents[3], ']');
}

/// Returns the value of the element at `at`. No two elements have the same value.
float value_at(const Extents& at) {
  return static_cast<float>(((at[0] * kY + at[1]) * kX + at[2]) * kComponents + at[3]) - 20.0F;
}

template <typename Visit>
void for_each_position(const Extents& end, const Visit& visit) {
  for (std::int64_t a = 0; a < end[0]; ++a) {
    for (std::int64_t b = 0; b < end[1]; ++b) {
      for (std::int64_t c = 0; c < end[2]; ++c) {
        for (std::int64_t d = 0; d < end[3]; ++d) visit(Extents{a, b, c, d});
      }
    }
  }
}

std::size_t place_in_chunk(const Extents& at, const Extents& chunk, bool last_is_fastest) {
  std::int64_t place = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::size_t axis = last_is_fastest ? i : at.size() - 1 - i;
    place = place * chunk.at(axis) + at.at(axis);
  }
  return static_cast<std::size_t>(place);
}

/// Writes value_at() for an array of kShape in chunks of `chunk`. Chunk elements beyond the array are -99.
void write_vectors(const ZarrFiles& files, const Extents& chunk, bool last_is_fastest) {
  files.write(".zarray", cat(R"({"zarr_format":2,"shape":)", list_text(kShape), R"(,"chunks":)", list_text(chunk),
                             R"(,"dtype":"<f4","fill_value":7,"compressor":null,"filters":null,"order":")",
                             last_is_fastest ? 'C' : 'F', "\"}"));
  Extents chunks{};
  for (std::size_t i = 0; i < chunks.size(); ++i) chunks.at(i) = (kShape.at(i) + chunk.at(i) - 1) / chunk.at(i);
  for_each_position(chunks, [&](const Extents& position) {
    std::vector<float> values(static_cast<std::size_t>(chunk[0] * chunk[1] * chunk[2] * chunk[3]), -99.0F);
    for_each_position(chunk, [&](const Extents& in_chunk) {
      Extents at{};
      bool inside = true;
      for (std::size_t i = 0; i < at.size(); ++i) {
        at.at(i) = position.at(i) * chunk.at(i) + in_chunk.at(i);
        inside = inside && at.at(i) < kShape.at(i);
      }
      if (inside) values[place_in_chunk(in_chunk, chunk, last_is_fastest)] = value_at(at);
    });
    files.write_values(cat(position[0], '.', position[1], '.', position[2], '.', position[3]), values);
  });
}

std::vector<float> component_of(std::int64_t c) {
  std::vector<float> values;
  for_each_position({kZ, kY, kX, 1}, [&](const Extents& at) { values.push_back(value_at({at[0], at[1], at[2], c})); });
  return values;
}

/// Returns the magnitudes of all vectors. If `second` is given, it is the value of component 1 in each of them.
std::vector<float> magnitudes(std::optional<double> second = {}) {
  std::vector<float> values;
  for_each_position({kZ, kY, kX, 1}, [&](const Extents& at) {
    double sum = 0;
    for (std::int64_t c = 0; c < kComponents; ++c) {
      const double number = c == 1 && second ? *second : static_cast<double>(value_at({at[0], at[1], at[2], c}));
      sum += number * number;
    }
    values.push_back(static_cast<float>(std::sqrt(sum)));
  });
  return values;
}

SourceOptions options_for(const ComponentChoice& choice, std::vector<std::int64_t> index = {}) {
  SourceOptions options;
  options.component = choice;
  options.index = std::move(index);
  return options;
}

TEST(ZarrComponents, EveryWayToCutChunks_GivesTheSameComponentsAndMagnitude) {
  for (const Extents& chunk :
       {kShape, Extents{1, 2, 3, 3}, Extents{2, 3, 2, 1}, Extents{1, 3, 4, 2}, Extents{2, 2, 3, 5}}) {
    for (const bool last_is_fastest : {true, false}) {
      SCOPED_TRACE(cat(list_text(chunk), last_is_fastest ? " C" : " F"));
      const ZarrFiles files;
      write_vectors(files, chunk, last_is_fastest);
      for (std::int64_t c = 0; c < kComponents; ++c) EXPECT_EQ(files.read(options_for({false, c})), component_of(c));
      EXPECT_EQ(files.read(options_for(kMagnitude)), magnitudes());
    }
  }
}

TEST(ZarrComponents, BoxesAcrossChunks_AreReadInParts) {
  const ZarrFiles files;
  write_vectors(files, {1, 2, 3, 2}, true);
  SourceOptions options = options_for(kMagnitude);
  options.roi = Box{{1, 1, 0}, {4, 3, 2}};
  const std::vector<float> whole = magnitudes();
  std::vector<float> part;
  for (const std::int64_t z : {0, 1}) {
    for (const std::int64_t y : {1, 2}) {
      for (const std::int64_t x : {1, 2, 3}) part.push_back(whole[static_cast<std::size_t>((z * kY + y) * kX + x)]);
    }
  }
  EXPECT_EQ(files.read(options), part);
}

TEST(ZarrComponents, ChunkOfOneComponentThatIsNotStored_ReadsAsTheFillValue) {
  const ZarrFiles files;
  write_vectors(files, {2, 3, 4, 1}, true);
  std::filesystem::remove(files.path("0.0.0.1"));
  const auto source = open_source(files.path(), options_for(kMagnitude));
  EXPECT_EQ(ZarrFiles::read_all(*source), magnitudes(7));
  EXPECT_EQ(source->info().details.chunks_note, "1 of its 3 chunks is not stored and reads as its fill value, 7");
  EXPECT_EQ(files.read(options_for({false, 1})), std::vector<float>(kX * kY * kZ, 7));
  for (const char* key : {"0.0.0.0", "0.0.0.2"}) std::filesystem::remove(files.path(key));
  EXPECT_EQ(files.read(options_for(kMagnitude)),
            std::vector<float>(kX * kY * kZ, static_cast<float>(std::sqrt(3.0 * 49.0))));
  SourceOptions strict = options_for(kMagnitude);
  strict.missing_chunks = MissingChunks::error;
  EXPECT_EQ(files.message(ErrorKind::input, strict),
            "run.zarr/0.0.0.0: chunk at 0, 0, 0, 0: is not stored; 3 of its 3 chunks are not, and with "
            "--missing-chunks error all must be; write it, or use --missing-chunks fill");
}

TEST(ZarrComponents, InChunksOfTheirOwnInAShard_AreGathered) {
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[1,1,2,2]", "[1,1,2,2]",
                                     R"([{"name":"sharding_indexed","configuration":{"chunk_shape":[1,1,2,1],)"
                                     R"("codecs":[{"name":"bytes"}],)"
                                     R"("index_codecs":[{"name":"bytes","configuration":{"endian":"little"}}]}}])"));
  std::string shard{3, 6, 4, 8};  // x of two voxels, then y of two voxels
  for (const std::uint64_t number : {0, 2, 2, 2}) {
    for (unsigned byte = 0; byte < 8; ++byte) shard += static_cast<char>(number >> (8 * byte));
  }
  files.write("c/0/0/0/0", shard);
  EXPECT_EQ(files.read(options_for(kMagnitude)), (std::vector<float>{5, 10}));
  EXPECT_EQ(files.read(options_for({false, 1})), (std::vector<float>{4, 8}));
}

TEST(ZarrComponents, LeadingAxes_AreChosenByIndexBesides) {
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[2,1,1,2,2]", "[2,1,1,2,2]", R"([{"name":"bytes"}])", "uint8", "0",
                                     R"(,"dimension_names":["t","z","y","x","component"])"));
  files.write_values("c/0/0/0/0/0", std::vector<std::uint8_t>{1, 2, 3, 4, 3, 4, 6, 8});
  EXPECT_EQ(files.read(options_for(kMagnitude, {1})), (std::vector<float>{5, 10}));
  const auto source = open_source(files.path(), options_for({false, 1}, {0}));
  EXPECT_EQ(ZarrFiles::read_all(*source), (std::vector<float>{2, 4}));
  EXPECT_EQ(source->info().index, std::vector<std::int64_t>{0});
  EXPECT_EQ(source->info().details.component, "1");
  EXPECT_EQ(source->info().axis_labels, (std::array<std::string, 3>{"x", "y", "z"}));
}

TEST(ZarrComponents, ALeadingAxisOfThem_IsChosenFromToo) {
  for (const char* chunk : {"[3,1,1,4]", "[1,1,1,4]"}) {
    const ZarrFiles files;
    files.write("zarr.json", zarr_json("[3,1,1,4]", chunk, R"([{"name":"bytes"}])", "uint8", "0",
                                       R"(,"dimension_names":["vector","z","y","x"])"));
    const std::vector<std::uint8_t> values{2, 4, 0, 1, 3, 4, 0, 2, 6, 7, 5, 2};
    if (std::string_view(chunk).starts_with("[3")) {
      files.write_values("c/0/0/0/0", values);
    } else {
      for (std::ptrdiff_t c = 0; c < 3; ++c) {
        files.write_values(cat("c/", c, "/0/0/0"),
                           std::vector<std::uint8_t>(values.begin() + 4 * c, values.begin() + 4 * c + 4));
      }
    }
    EXPECT_EQ(files.read(options_for(kMagnitude)), (std::vector<float>{7, 9, 5, 3})) << chunk;
    EXPECT_EQ(files.read(options_for({false, 1})), (std::vector<float>{3, 4, 0, 2})) << chunk;
    const auto source = open_source(files.path(), options_for({false, 2}));
    EXPECT_EQ(source->info().index, std::vector<std::int64_t>{}) << "the component says it";
    EXPECT_EQ(list_zarr(files.path(), {})[0].leading_axes, 1U) << "each is a volume as it is";
  }
}

TEST(ZarrComponents, IndexChoices_AreOfTheAxesThatPositionsAreOf) {
  const auto first_value = [](const ZarrFiles& files, SourceOptions options, const char* choice) {
    options.index_choices = {*parse_axis_choice(choice)};
    return files.read(options).front();
  };
  const ZarrFiles unnamed;
  write_vectors(unnamed, kShape, true);
  EXPECT_EQ(first_value(unnamed, {}, "-1"), value_at({1, 0, 0, 0})) << "components are x";
  EXPECT_EQ(message_of_error(ErrorKind::usage,
                             [&] {
                               first_value(unnamed, options_for({false, 1}), "-1");
                             }),
            unnamed.path() +
                ": --index has 1 position, and the array has no leading axis; weir inspect lists what "
                "there is");
  const ZarrFiles leading;
  leading.write("zarr.json", zarr_json("[2,3,1,1,1]", "[2,3,1,1,1]", R"([{"name":"bytes"}])", "uint8", "0",
                                       R"(,"dimension_names":["t","vector","z","y","x"])"));
  leading.write_values("c/0/0/0/0/0", std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
  EXPECT_EQ(first_value(leading, options_for({false, 1}), "-1"), 5);
  EXPECT_EQ(first_value(leading, options_for({false, 1}), "t=0"), 2);
}

TEST(ZarrComponents, ScaleAndMissingValues_AreOfEachNumber) {
  const ZarrFiles files;
  files.write(".zarray", zarray("[1,1,3,2]", "[1,1,3,1]", "|u1", "0"));
  files.write(".zattrs", R"({"scale_factor":0.5,"missing_value":255})");
  files.write_values("0.0.0.0", std::vector<std::uint8_t>{6, 255, 12});
  files.write_values("0.0.0.1", std::vector<std::uint8_t>{8, 1, 16});
  const auto source = open_source(files.path(), options_for(kMagnitude));
  const std::vector<float> values = ZarrFiles::read_all(*source);
  EXPECT_EQ(values[0], 5.0F);
  EXPECT_TRUE(is_missing(values[1]));
  EXPECT_EQ(values[2], 10.0F);
  EXPECT_TRUE(source->info().lengths);
}

TEST(ZarrComponents, Inspect_SaysHowSureItIsAndWhatToGive) {
  const ZarrFiles files;
  write_vectors(files, kShape, true);
  const DatasetInfo listed = list_zarr(files.path(), {})[0];
  EXPECT_EQ(listed.components, 3);
  EXPECT_EQ(listed.leading_axes, 0U);
  EXPECT_EQ(listed.obstacle, "");
  EXPECT_EQ(listed.attributes.back(),
            (std::pair<std::string, std::string>{"components", "3 along the last axis, by its extent alone"}));
  EXPECT_EQ(convert_command("run.zarr", true, listed), "weir convert run.zarr --component magnitude");
}

TEST(ZarrComponents, ChoicesThatAreNone_AreErrorsOfUse) {
  const ZarrFiles files;
  write_vectors(files, kShape, true);
  const std::string axes = "run.zarr: its axes are 2, 3, 4, 3";
  EXPECT_EQ(files.message(ErrorKind::usage),
            axes +
                ", the last of them of components (by its extent alone); give --component: 0 to 2, x, y, z or "
                "magnitude; or --index with 1 position for volumes of 3 voxels along x");
  EXPECT_EQ(files.message(ErrorKind::usage, options_for({false, 3})),
            axes + ", and --component is 3; give 0 to 2, x, y, z or magnitude");
  SourceOptions as_x;
  as_x.index = {1};
  EXPECT_EQ(open_source(files.path(), as_x)->info().extent, (Index3{kComponents, kX, kY}));
  files.write(".zarray", zarray("[1,1,3]", "[1,1,3]"));
  EXPECT_EQ(files.message(ErrorKind::usage, options_for(kMagnitude)),
            "run.zarr: its axes are 1, 1, 3, none of them of components; leave --component out");
}

TEST(ZarrComponents, TheOnlyArrayOfVectors_IsTheDefault) {
  const ZarrFiles files;
  files.write(".zgroup", R"({"zarr_format":2})");
  files.write("p/.zarray", zarray("[1,1,2]", "[1,1,2]"));
  files.write("v/.zarray", zarray("[1,1,2,2]", "[1,1,2,2]"));
  files.write_values("v/0.0.0.0", std::vector<std::uint8_t>{3, 4, 6, 8});
  EXPECT_EQ(files.read(options_for(kMagnitude)), (std::vector<float>{5, 10}));
  EXPECT_EQ(files.message(ErrorKind::usage),
            cat("run.zarr: holds 2 volumes; choose one with --dataset: weir convert ", files.path(),
                " --dataset p; weir convert ", files.path(), " --dataset v --component magnitude"));
}

}  // namespace
}  // namespace weir::zarr_components_test
