/* Conversions of arrays: whatever type, order and place, the bytes are those of a conversion of a raw file. */
#include "check.h"

#include <math.h>
#include <sys/stat.h>

static weir_error error;

/* x fastest, as a raw file of that type. */
static void write_raw(const char* path, const void* values, size_t bytes) {
  FILE* const file = fopen(path, "wb");
  if (file == NULL || fwrite(values, 1, bytes, file) != bytes || fclose(file) != 0) abort();
}

#define FILL(type)                                                             \
  do {                                                                         \
    for (int z = 0; z < NZ; ++z) {                                             \
      for (int y = 0; y < NY; ++y) {                                           \
        for (int x = 0; x < NX; ++x) {                                         \
          ((type*)packed)[x + NX * (y + NY * z)] = (type)pattern(x, y, z);     \
          ((type*)transposed)[z + NZ * (y + NY * x)] = (type)pattern(x, y, z); \
        }                                                                      \
      }                                                                        \
    }                                                                          \
  } while (0)

static void fill(int32_t type, void* packed, void* transposed) {
  switch (type) {
    case WEIR_UINT8:
      FILL(uint8_t);
      break;
    case WEIR_INT8:
      FILL(int8_t);
      break;
    case WEIR_UINT16:
    case WEIR_FLOAT16: /* of small whole numbers as bits: tiny values */
      FILL(uint16_t);
      break;
    case WEIR_INT16:
      FILL(int16_t);
      break;
    case WEIR_UINT32:
      FILL(uint32_t);
      break;
    case WEIR_INT32:
      FILL(int32_t);
      break;
    case WEIR_UINT64:
      FILL(uint64_t);
      break;
    case WEIR_INT64:
      FILL(int64_t);
      break;
    case WEIR_FLOAT32:
      FILL(float);
      break;
    default:
      FILL(double);
  }
}

static void every_type_in_every_order(void) {
  static const int bytes_of[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
  void* const packed = malloc(8 * VOXELS);
  void* const transposed = malloc(8 * VOXELS);
  for (int32_t type = WEIR_UINT8; type <= WEIR_FLOAT64; ++type) {
    const int64_t bytes = bytes_of[type];
    fill(type, packed, transposed);
    write_raw(path_of("v.raw"), packed, (size_t)bytes * VOXELS);
    weir_convert_options options = default_options();
    options.overwrite = 1;
    weir_input_options input;
    CHECK(weir_input_options_init(&input, sizeof input) == WEIR_OK);
    input.extent[0] = NX;
    input.extent[1] = NY;
    input.extent[2] = NZ;
    input.type = type;
    CHECK_OK(weir_convert_file(path_of("v.raw"), &input, &options, path_of("raw.nvdb"), &error));

    const weir_volume volume = pattern_volume(type);
    CHECK_OK(weir_convert(&volume, packed, NULL, &options, path_of("packed.nvdb"), &error));
    CHECK(same_files(path_of("raw.nvdb"), path_of("packed.nvdb")));
    CHECK(exists(path_of("packed.nvdb.json")));

    const int64_t z_fastest[3] = {bytes * NZ * NY, bytes * NZ, bytes};
    weir_buffer* buffer = NULL;
    CHECK_OK(weir_convert_to_memory(&volume, transposed, z_fastest, NULL, &buffer, &error));
    size_t size = 0;
    unsigned char* const file = read_file(path_of("raw.nvdb"), &size);
    CHECK(weir_buffer_size(buffer) == size && memcmp(weir_buffer_data(buffer), file, size) == 0);
    CHECK((uintptr_t)weir_buffer_data(buffer) % 4096 == 0);
    CHECK(strstr(weir_buffer_sidecar(buffer), "\"format\":\"memory\"") != NULL ||
          strstr(weir_buffer_sidecar(buffer), "\"format\": \"memory\"") != NULL);
    weir_buffer_free(buffer);
    free(file);
  }
  free(packed);
  free(transposed);
}

static uint64_t size_of(const char* path) {
  size_t bytes = 0;
  free(read_file(path, &bytes));
  return bytes;
}

static weir_grid_info info_of(const char* path) {
  weir_grid* grid = NULL;
  weir_grid_info info;
  CHECK(weir_grid_info_init(&info, sizeof info) == WEIR_OK);
  CHECK_OK(weir_open(path, &grid, &error));
  CHECK_OK(weir_get_info(grid, &info, &error));
  weir_close(grid);
  CHECK(info.certified == 1);
  return info;
}

/* In memory and on a disk; the volume's bytes are those of one without. */
static void certified_gradient(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  weir_convert_options options = default_options();
  options.overwrite = 1;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("plain.nvdb"), &error));
  size_t size = 0;
  unsigned char* const plain = read_file(path_of("plain.nvdb"), &size);
  options.certify = WEIR_CERTIFY_GRADIENT;
  weir_buffer* buffer = NULL;
  CHECK_OK(weir_convert_to_memory(&volume, values, NULL, &options, &buffer, &error));
  CHECK(weir_buffer_size(buffer) == size && memcmp(weir_buffer_data(buffer), plain, size) == 0);
  const char* const in_memory = strstr(weir_buffer_sidecar(buffer), "\"gradient\":{\"rms\":");
  CHECK(in_memory != NULL);
  CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("certified.nvdb"), &error));
  CHECK(same_files(path_of("plain.nvdb"), path_of("certified.nvdb")));
  weir_grid* grid = NULL;
  CHECK_OK(weir_open(path_of("certified.nvdb"), &grid, &error));
  const char* const on_disk = strstr(weir_grid_sidecar(grid), "\"gradient\":{\"rms\":");
  CHECK(on_disk != NULL && in_memory != NULL);
  CHECK(strncmp(on_disk, in_memory, (size_t)(strchr(in_memory, '}') - in_memory)) == 0);
  weir_close(grid);
  weir_buffer_free(buffer);
  free(plain);
}

static void every_budget(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  const char* const output = path_of("budget.nvdb");
  weir_convert_options options = default_options();
  options.overwrite = 1;

  options.budget_kind = WEIR_BUDGET_SIZE;
  options.size = 400001;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, output, &error));
  CHECK(size_of(output) == 400001);
  options.size = 1;
  CHECK_STATUS(WEIR_ERROR_BUDGET, weir_convert(&volume, values, NULL, &options, output, &error));
  CHECK(size_of(output) == 400001);
  options.size = 0;

  options.budget_kind = WEIR_BUDGET_RATE;
  options.budget = 1.25;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, output, &error));
  CHECK(size_of(output) == (4 * VOXELS * 4 + 4) / 5);

  options.budget_kind = WEIR_BUDGET_PSNR;
  options.budget = 40;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, output, &error));
  CHECK(info_of(output).psnr_db >= 40);

  options.budget_kind = WEIR_BUDGET_MAX_ERROR;
  options.budget = 0.5;
  options.encoding = WEIR_ENCODING_FPN;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, output, &error));
  CHECK(info_of(output).max_abs_error <= 0.5);
  CHECK(info_of(output).encoding == WEIR_ENCODING_FPN);
  options.budget = 0;

  options.budget_kind = WEIR_BUDGET_LOSSLESS;
  options.encoding = WEIR_ENCODING_FLOAT;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, output, &error));
  CHECK(info_of(output).lossless == 1 && isinf(info_of(output).psnr_db));
  CHECK(info_of(output).encoding == WEIR_ENCODING_FLOAT);

  options.budget_kind = WEIR_BUDGET_AUTO;
  options.metric = WEIR_METRIC_FARTHEST;
  options.fill = WEIR_FILL_BACKGROUND;
  options.brick = 16;
  options.has_background = 1;
  options.background = 3;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, output, &error));
  CHECK(info_of(output).background == 3);
  CHECK(info_of(output).source_range[0] == 0 && info_of(output).source_range[1] == 100);
}

static void values_that_are_none(const float* values) {
  float* const holed = malloc(sizeof(float) * VOXELS);
  memcpy(holed, values, sizeof(float) * VOXELS);
  holed[5] = NAN;
  holed[VOXELS - 1] = -INFINITY;
  holed[77] = -9999;
  weir_volume volume = pattern_volume(WEIR_FLOAT32);
  volume.missing = "-9999";
  weir_convert_options options = default_options();
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_convert(&volume, holed, NULL, &options, path_of("holed.nvdb"), &error));
  CHECK_TEXT(
      "memory: 2 voxels are NaN or infinite, the first (nan) at 5,0,0; choose WEIR_NONFINITE_BACKGROUND or "
      "WEIR_NONFINITE_KEEP",
      error.message);
  CHECK(!exists(path_of("holed.nvdb")) && !exists(path_of("holed.nvdb.partial")));
  options.nonfinite = WEIR_NONFINITE_KEEP;
  CHECK_OK(weir_convert(&volume, holed, NULL, &options, path_of("holed.nvdb"), &error));
  CHECK(info_of(path_of("holed.nvdb")).nonfinite == 2);
  CHECK(info_of(path_of("holed.nvdb")).missing == 1);
  options.overwrite = 1;
  options.nonfinite = WEIR_NONFINITE_BACKGROUND;
  options.missing_policy = WEIR_MISSING_POLICY_ERROR;
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_convert(&volume, holed, NULL, &options, path_of("holed.nvdb"), &error));
  CHECK(strstr(error.message, " holds no data (stored as -9999), the first at ") != NULL);
  CHECK(strstr(error.message,
               "; choose WEIR_MISSING_POLICY_BACKGROUND or, to take -9999 for data, "
               "WEIR_MISSING_POLICY_KEEP") != NULL);
  options.missing_policy = WEIR_MISSING_POLICY_KEEP;
  CHECK_OK(weir_convert(&volume, holed, NULL, &options, path_of("holed.nvdb"), &error));
  CHECK(info_of(path_of("holed.nvdb")).missing == 1);
  CHECK(info_of(path_of("holed.nvdb")).source_range[0] == -9999);
  free(holed);
}

struct seen {
  int survey, encode, asked, stop_after;
  uint64_t last;
};

static void see_progress(void* user, const char* pass, uint64_t done, uint64_t total) {
  struct seen* const seen = user;
  seen->survey += strcmp(pass, "survey") == 0;
  seen->encode += strcmp(pass, "encode") == 0;
  seen->last = done;
  CHECK(done <= total);
}
static int ask_cancel(void* user) {
  struct seen* const seen = user;
  return ++seen->asked > seen->stop_after;
}

static void callbacks(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  struct seen seen = {0, 0, 0, 1 << 30, 0};
  weir_convert_options options = default_options();
  options.progress = see_progress;
  options.cancel = ask_cancel;
  options.user = &seen;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("seen.nvdb"), &error));
  CHECK(seen.survey >= 2 && seen.encode >= 1 && seen.asked >= 3);
  const int calls = seen.asked;
  for (int stop = 0; stop < calls - 1; ++stop) {
    seen.asked = 0;
    seen.stop_after = stop;
    CHECK_STATUS(WEIR_INTERRUPTED, weir_convert(&volume, values, NULL, &options, path_of("stopped.nvdb"), &error));
    CHECK(!exists(path_of("stopped.nvdb")) && !exists(path_of("stopped.nvdb.json")));
    CHECK(!exists(path_of("stopped.nvdb.partial")) && !exists(path_of(".stopped.nvdb.work")));
  }
}

/* Of vectors (v, 2 v, -2 v), whose length is 3 v, the component that is named becomes the volume. */
static void components(const float* values) {
  static const char* const names[] = {"0", "y", "2", "magnitude"};
  static const float factors[] = {1, 2, -2, 3};
  char path[512];
  snprintf(path, sizeof path, "%s", path_of("vectors.vtk"));
  FILE* const file = fopen(path, "w");
  if (file == NULL) abort();
  fprintf(file, "# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS %d %d %d\n", NX, NY, NZ);
  fprintf(file, "ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA %d\nVECTORS v float\n", VOXELS);
  for (int i = 0; i < VOXELS; ++i) {
    fprintf(file, "%g %g %g\n", (double)values[i], 2 * (double)values[i], -2 * (double)values[i]);
  }
  if (fclose(file) != 0) abort();

  weir_convert_options options = default_options();
  options.overwrite = 1;
  float* const expected = malloc(sizeof(float) * VOXELS);
  weir_volume volume = pattern_volume(WEIR_FLOAT32);
  volume.name = "v";
  weir_input_options input;
  CHECK(weir_input_options_init(&input, sizeof input) == WEIR_OK);
  for (int i = 0; i < 4; ++i) {
    input.component = names[i];
    CHECK_OK(weir_convert_file(path, &input, &options, path_of("component.nvdb"), &error));
    for (int v = 0; v < VOXELS; ++v) expected[v] = factors[i] * values[v];
    CHECK_OK(weir_convert(&volume, expected, NULL, &options, path_of("expected.nvdb"), &error));
    CHECK(same_files(path_of("component.nvdb"), path_of("expected.nvdb")));
  }
  free(expected);
  input.component = NULL;
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_convert_file(path, &input, &options, path_of("none.nvdb"), &error));
  CHECK(strstr(error.message, "array 'v': has 3 components a voxel; give component: 0 to 2, x, y, z or magnitude"));
  input.component = "3";
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_convert_file(path, &input, &options, path_of("none.nvdb"), &error));
  CHECK(strstr(error.message, "array 'v': has 3 components a voxel, and component is 3; give 0 to 2"));
}

static void write_text(const char* path, const char* text) { write_raw(path, text, strlen(text)); }

/* A plotfile of 8^3 cells of 1, the middle 4^3 of them refined by 2, of 2. */
static void write_levels(const char* path) {
  static const char* const kBoxes[] = {"((0,0,0) (7,7,7) (0,0,0))", "((4,4,4) (11,11,11) (0,0,0))"};
  char name[1200];
  char text[1200];
  mkdir(path, 0777);
  snprintf(name, sizeof name, "%s/Header", path);
  write_text(
      name,
      "HyperCLaw-V1.1\n1\nrho\n3\n0\n1\n0 0 0\n8 8 8\n2\n((0,0,0) (7,7,7) (0,0,0)) ((0,0,0) (15,15,15) (0,0,0))\n"
      "1 1\n1 1 1\n0.5 0.5 0.5\n0\n0\n0 1 0\n1\n0 8\n0 8\n0 8\nLevel_0/Cell\n1 1 0\n1\n2 6\n2 6\n2 6\n"
      "Level_1/Cell\n");
  for (int level = 0; level < 2; ++level) {
    snprintf(name, sizeof name, "%s/Level_%d", path, level);
    mkdir(name, 0777);
    snprintf(name, sizeof name, "%s/Level_%d/Cell_H", path, level);
    snprintf(text, sizeof text, "1\n1\n1\n0\n(1 0\n%s\n)\n1\nFabOnDisk: Cell_D_00000 0\n\n1,1\n1,\n\n1,1\n1,\n\n",
             kBoxes[level]);
    write_text(name, text);
    snprintf(name, sizeof name, "%s/Level_%d/Cell_D_00000", path, level);
    FILE* const fab = fopen(name, "wb");
    if (fab == NULL) abort();
    fprintf(fab, "FAB ((8, (32 8 23 0 1 9 0 127)),(4, (4 3 2 1)))%s 1\n", kBoxes[level]);
    for (int i = 0; i < 512; ++i) {
      const float value = (float)(level + 1);
      fwrite(&value, sizeof value, 1, fab);
    }
    if (fclose(fab) != 0) abort();
  }
}

static void separate_levels(void) {
  const char* const path = path_of("plt00001");
  write_levels(path);
  weir_input_options input;
  CHECK(weir_input_options_init(&input, sizeof input) == WEIR_OK);
  input.levels = WEIR_LEVELS_SEPARATE;
  weir_convert_options options = default_options();
  options.has_background = 1;
  options.background = -1;
  CHECK_OK(weir_convert_file(path, &input, &options, path_of("rho.nvdb"), &error));
  static const int64_t kPlaces[2][3] = {{4, 7, 11}, {1, 3, 6}}; /* of the coarse level the middle one is refined */
  static const float kExpected[2][3] = {{2, 2, 2}, {1, -1, 1}};
  for (int n = 0; n < 2; ++n) {
    weir_grid* grid = NULL;
    CHECK_OK(weir_open(path_of(n == 0 ? "rho_level_0.nvdb" : "rho_level_1.nvdb"), &grid, &error));
    for (int i = 0; i < 3; ++i) {
      const int64_t at = kPlaces[n][i];
      const int64_t index[3] = {at, at, at};
      float value = 0;
      CHECK_OK(weir_value(grid, index, &value, &error));
      CHECK(value == kExpected[n][i]);
    }
    weir_close(grid);
  }
  CHECK(!exists(path_of("rho.nvdb")));
  options.nonfinite = WEIR_NONFINITE_KEEP;
  CHECK_USAGE(
      "WEIR_NONFINITE_KEEP does not go with WEIR_LEVELS_SEPARATE, whose voxels without a value become the "
      "background; use background",
      weir_convert_file(path, &input, &options, path_of("other.nvdb"), &error));
}

static void places(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  weir_convert_options options = default_options();
  const char* const output = path_of("place.nvdb");
  CHECK_OK(weir_convert(&volume, values, NULL, NULL, output, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_convert(&volume, values, NULL, NULL, output, &error));
  CHECK_STATUS(WEIR_ERROR_IO,
               weir_convert(&volume, values, NULL, NULL, path_of("none/place.nvdb"), NULL) == WEIR_ERROR_IO
                   ? (error.status = WEIR_ERROR_IO)
                   : WEIR_OK);
  options.work_dir = path_of("none");
  CHECK_STATUS(WEIR_ERROR_IO, weir_convert(&volume, values, NULL, &options, path_of("b.nvdb"), &error));
  options.work_dir = directory;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("b.nvdb"), &error));
  CHECK(same_files(output, path_of("b.nvdb")));
  weir_buffer* buffer = NULL;
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_convert_to_memory(&volume, values, NULL, &options, &buffer, &error));
  CHECK(buffer == NULL);
}

int main(void) {
  make_directory();
  float* const values = pattern_floats();
  every_type_in_every_order();
  every_budget(values);
  certified_gradient(values);
  values_that_are_none(values);
  callbacks(values);
  components(values);
  separate_levels();
  places(values);
  free(values);
  return finish();
}
