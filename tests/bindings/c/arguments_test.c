/* Every call with wrong arguments: refused with a line that says which, and nothing done. */
#include "check.h"

#include <math.h>
#include <stddef.h>

static weir_error error;
static float* values;
static weir_volume volume;

/* No call may crash where `error` is NULL either. */
static void null_pointers(void) {
  weir_buffer* buffer = NULL;
  weir_grid* grid = NULL;
  weir_push* push = NULL;
  const char* const output = path_of("a.nvdb");
  CHECK(weir_volume_init(NULL, sizeof volume) == WEIR_ERROR_USAGE);
  CHECK(weir_convert_options_init(NULL, 1000) == WEIR_ERROR_USAGE);
  CHECK(weir_input_options_init(NULL, 1000) == WEIR_ERROR_USAGE);
  CHECK(weir_grid_info_init(NULL, 1000) == WEIR_ERROR_USAGE);
  CHECK_USAGE("weir_volume is a null pointer", weir_convert(NULL, values, NULL, NULL, output, &error));
  CHECK_USAGE("data is a null pointer", weir_convert(&volume, NULL, NULL, NULL, output, &error));
  CHECK_USAGE("output is a null pointer", weir_convert(&volume, values, NULL, NULL, NULL, &error));
  CHECK_USAGE("output is empty; name a file", weir_convert(&volume, values, NULL, NULL, "", &error));
  CHECK_USAGE("buffer is a null pointer", weir_convert_to_memory(&volume, values, NULL, NULL, NULL, &error));
  CHECK_USAGE("data is a null pointer", weir_convert_to_memory(&volume, NULL, NULL, NULL, &buffer, &error));
  CHECK_USAGE("input is a null pointer", weir_convert_file(NULL, NULL, NULL, output, &error));
  CHECK_USAGE("input is empty; name a file", weir_convert_file("", NULL, NULL, output, &error));
  CHECK_USAGE("output is a null pointer", weir_convert_file(output, NULL, NULL, NULL, &error));
  CHECK_USAGE("push is a null pointer", weir_push_begin(&volume, NULL, output, NULL, &error));
  CHECK_USAGE("weir_volume is a null pointer", weir_push_begin(NULL, NULL, output, &push, &error));
  CHECK_USAGE("output is a null pointer", weir_push_begin(&volume, NULL, NULL, &push, &error));
  CHECK_USAGE("push is a null pointer", weir_push_slab(NULL, 0, 1, values, NULL, &error));
  CHECK_USAGE("push is a null pointer", weir_push_end(NULL, &error));
  CHECK_USAGE("path is a null pointer", weir_open(NULL, &grid, &error));
  CHECK_USAGE("path is empty; name a file", weir_open("", &grid, &error));
  CHECK_USAGE("grid is a null pointer", weir_open(output, NULL, &error));
  CHECK_USAGE("data is a null pointer", weir_open_memory(NULL, 10, NULL, &grid, &error));
  CHECK_USAGE("grid is a null pointer", weir_open_memory(values, 10, NULL, NULL, &error));
  CHECK(weir_convert(NULL, NULL, NULL, NULL, NULL, NULL) == WEIR_ERROR_USAGE);
  CHECK(weir_open(NULL, NULL, NULL) == WEIR_ERROR_USAGE);
  CHECK(weir_push_end(NULL, NULL) == WEIR_ERROR_USAGE);
  CHECK(buffer == NULL && grid == NULL && push == NULL);
  weir_buffer_free(NULL);
  weir_push_free(NULL);
  weir_close(NULL);
  CHECK(weir_buffer_data(NULL) == NULL && weir_buffer_size(NULL) == 0 && weir_buffer_sidecar(NULL) == NULL);
  CHECK(weir_grid_name(NULL) == NULL && weir_grid_sidecar(NULL) == NULL && weir_grid_data(NULL) == NULL);
  CHECK(!exists(output));
}

/* A struct that was not set up, of an older or a newer header. */
static void struct_sizes(void) {
  struct {
    weir_convert_options known;
    int64_t later;
  } newer;
  weir_buffer* buffer = NULL;
  CHECK(weir_convert_options_init(&newer.known, 8) == WEIR_ERROR_USAGE);
  CHECK(weir_convert_options_init(&newer.known, 4097) == WEIR_ERROR_USAGE);
  CHECK(weir_convert_options_init(&newer.known, sizeof newer) == WEIR_OK);
  CHECK_OK(weir_convert_to_memory(&volume, values, NULL, &newer.known, &buffer, &error));
  weir_buffer_free(buffer);
  buffer = NULL;
  newer.later = 1;
  char message[200];
  snprintf(message, sizeof message,
           "weir_convert_options: sets members that are newer than this library, %s; leave them 0", weir_version());
  CHECK_USAGE(message, weir_convert_to_memory(&volume, values, NULL, &newer.known, &buffer, &error));
  newer.known.struct_size = 17;
  snprintf(message, sizeof message,
           "weir_convert_options: struct_size is 17, and must be at least %zu; set it up with "
           "weir_convert_options_init",
           offsetof(weir_convert_options, preview));  /* what 0.1 had */
  CHECK_USAGE(message, weir_convert_to_memory(&volume, values, NULL, &newer.known, &buffer, &error));
  newer.known.struct_size = SIZE_MAX;
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_convert_to_memory(&volume, values, NULL, &newer.known, &buffer, &error));
  weir_volume zeros;
  memset(&zeros, 0, sizeof zeros);
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_convert_to_memory(&zeros, values, NULL, NULL, &buffer, &error));
  CHECK(buffer == NULL);
}

#define REFUSE_VOLUME(wanted_status, wanted, change)                                                \
  do {                                                                                              \
    weir_volume v = volume;                                                                         \
    weir_buffer* buffer = NULL;                                                                     \
    weir_push* push = NULL;                                                                         \
    change;                                                                                         \
    CHECK_STATUS(wanted_status, weir_convert_to_memory(&v, values, NULL, NULL, &buffer, &error));   \
    CHECK_TEXT(wanted, error.message);                                                              \
    CHECK_STATUS(wanted_status, weir_push_begin(&v, NULL, path_of("refused.nvdb"), &push, &error)); \
    CHECK_TEXT(wanted, error.message);                                                              \
    CHECK(buffer == NULL && push == NULL && !exists(path_of("refused.nvdb.partial")));              \
  } while (0)

static void volumes(void) {
  char name[257];
  memset(name, 'n', sizeof name);
  name[256] = 0;
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "type is 0, it must be 1 to 12", v.type = 0);
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "type is 13, it must be 1 to 12", v.type = 13);
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "name has 256 bytes, a grid's has at most 255", v.name = name);
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "name is no UTF-8, which a grid's name must be", v.name = "Gr\xF6sse");
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "missing is \"none\", it must be a number or nan", v.missing = "none");
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "reserved is 1, it must be 0", v.reserved = 1);
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "memory: the spacing has 0; each must be finite and above 0", v.spacing[1] = 1);
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "memory: the origin has nan; each must be finite", v.origin[2] = NAN);
  REFUSE_VOLUME(WEIR_ERROR_USAGE, "extent 70x37x0 has 0 voxels along z; each axis must be 1 to 2147483647",
                v.extent[2] = 0);
  REFUSE_VOLUME(WEIR_ERROR_USAGE,
                "extent 70x37x-9223372036854775808 has -9223372036854775808 voxels along z; each axis must be "
                "1 to 2147483647",
                v.extent[2] = INT64_MIN);
  const int64_t stride[3] = {4, INT64_MAX, 4};
  CHECK_USAGE(
      "memory: a stride of 9223372036854775807 bytes along y for 37 voxels leaves the address space; strides "
      "are in bytes",
      weir_convert(&volume, values, stride, NULL, path_of("a.nvdb"), &error));
}

#define REFUSE_OPTIONS(wanted, change)                                                             \
  do {                                                                                             \
    weir_convert_options o = default_options();                                                    \
    change;                                                                                        \
    CHECK_USAGE(wanted, weir_convert(&volume, values, NULL, &o, path_of("a.nvdb"), &error));       \
    CHECK_USAGE(wanted, weir_convert_file(path_of("x.raw"), NULL, &o, path_of("a.nvdb"), &error)); \
    weir_push* push = NULL;                                                                        \
    CHECK_USAGE(wanted, weir_push_begin(&volume, &o, path_of("a.nvdb"), &push, &error));           \
  } while (0)

static void options(void) {
  REFUSE_OPTIONS("budget_kind is 6, it must be 0 to 5", o.budget_kind = 6);
  REFUSE_OPTIONS("budget_kind is -1, it must be 0 to 5", o.budget_kind = -1);
  REFUSE_OPTIONS("budget (WEIR_BUDGET_RATE) is \"0\", it must be a positive number: dense float32 bytes / file bytes",
                 o.budget_kind = WEIR_BUDGET_RATE);
  REFUSE_OPTIONS("budget (WEIR_BUDGET_PSNR) is \"nan\", it must be a number of dB from 0.001 to 1000, 60 for instance", (o.budget_kind = WEIR_BUDGET_PSNR, o.budget = NAN));
  REFUSE_OPTIONS("budget (WEIR_BUDGET_MAX_ERROR) is \"-1\", it must be a number from 0 to 1e300, in the values' own unit",
                 (o.budget_kind = WEIR_BUDGET_MAX_ERROR, o.budget = -1));
  REFUSE_OPTIONS("budget is 8, and budget_kind is not WEIR_BUDGET_RATE, _PSNR or _MAX_ERROR; set one or the other",
                 o.budget = 8);
  REFUSE_OPTIONS("size (WEIR_BUDGET_SIZE) is \"0\", it must be a size such as 1048577, 64MiB or 1.5GB", o.budget_kind = WEIR_BUDGET_SIZE);
  REFUSE_OPTIONS("size (WEIR_BUDGET_SIZE) is \"18446744073709551615\", it must be a size of at most 2^62 bytes",
                 (o.budget_kind = WEIR_BUDGET_SIZE, o.size = UINT64_MAX));
  REFUSE_OPTIONS("size is 4096, and budget_kind is not WEIR_BUDGET_SIZE; set one or the other", o.size = 4096);
  REFUSE_OPTIONS("encoding is 7, it must be 0 to 6", o.encoding = 7);
  REFUSE_OPTIONS("preview is 3, it must be 0 to 2", o.preview = 3);
  REFUSE_OPTIONS("missing_policy is 4, it must be 0 to 3", o.missing_policy = 4);
  REFUSE_OPTIONS("at_most needs size (WEIR_BUDGET_SIZE) or budget (WEIR_BUDGET_RATE)", o.at_most = 1);
  REFUSE_OPTIONS("certify is 2, it must be 0 to 1", o.certify = 2);
  REFUSE_OPTIONS("reserved is 1, it must be 0", o.reserved = 1);
  REFUSE_OPTIONS("backend is 3, it must be 0 to 2", o.backend = 3);
  REFUSE_OPTIONS("metric is 4, it must be 0 to 3", o.metric = 4);
  REFUSE_OPTIONS("fill is 2, it must be 0 to 1", o.fill = 2);
  REFUSE_OPTIONS("nonfinite is 3, it must be 0 to 2", o.nonfinite = 3);
  REFUSE_OPTIONS("brick is \"9\", it must be 8, 16 or 32", o.brick = 9);
  REFUSE_OPTIONS("brick 16 is for WEIR_METRIC_FARTHEST, closest or median; sse chooses single leaves", o.brick = 16);
  REFUSE_OPTIONS("WEIR_METRIC_FARTHEST has no error target; budget (WEIR_BUDGET_PSNR) and budget (WEIR_BUDGET_MAX_ERROR) select by sse",
                 (o.metric = 1, o.budget_kind = WEIR_BUDGET_PSNR, o.budget = 50));
  REFUSE_OPTIONS("background is \"inf\", it must be auto or a finite float32", (o.has_background = 1, o.background = INFINITY));
  REFUSE_OPTIONS("background is 1, and has_background is 0; set it", o.background = 1);
  REFUSE_OPTIONS("threads is \"-1\", it must be a whole number from 0 to 4096", o.threads = -1);
  REFUSE_OPTIONS("memory is 18446744073709551615 bytes, it must be at most 2^50", o.memory = UINT64_MAX);

  weir_convert_options o = default_options();
  o.memory = 1;
  o.threads = 2;
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_convert(&volume, values, NULL, &o, path_of("a.nvdb"), &error));
  CHECK(strstr(error.message, "memory 1 B is too small for this volume with 2 threads; give at least ") != NULL);
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_convert(&volume, values, NULL, NULL, directory, &error));
  CHECK(strstr(error.message, ": is a directory; name a file in it") != NULL);
}

#define REFUSE_INPUT(wanted, change)                                                               \
  do {                                                                                             \
    weir_input_options i;                                                                          \
    weir_input_options_init(&i, sizeof i);                                                         \
    change;                                                                                        \
    CHECK_USAGE(wanted, weir_convert_file(path_of("x.raw"), &i, NULL, path_of("a.nvdb"), &error)); \
  } while (0)

static void inputs(void) {
  const int64_t index[2] = {0, 1};
  REFUSE_INPUT("type is 13, it must be 1 to 12", i.type = 13);
  REFUSE_INPUT("endian is 3, it must be 0 to 2", i.endian = 3);
  REFUSE_INPUT("index is a null pointer", i.index_count = 1);
  REFUSE_INPUT("index_count is 33, it must be at most 32", (i.index = index, i.index_count = 33));
  REFUSE_INPUT("component is \"w\", it must be x, y, z, magnitude or a whole number from 0 to 63", i.component = "w");
  REFUSE_INPUT("magnitude is \"u\", it must be the names of two datasets or more, u,v,w", i.magnitude = "u");
  REFUSE_INPUT("level is 1, and has_level is 0; set it", i.level = 1);
  REFUSE_INPUT("level is \"-1\", it must be a whole number from 0, the coarsest level, to 99",
               (i.level = -1, i.has_level = 1));
  REFUSE_INPUT("levels is 2, it must be 0 to 1", i.levels = 2);
  REFUSE_INPUT("upsample is 2, it must be 0 to 1", i.upsample = 2);
  REFUSE_INPUT("missing_chunks is 2, it must be 0 to 1", i.missing_chunks = 2);
  REFUSE_INPUT("component is empty; give a position, x, y, z or magnitude, or NULL", i.component = "");
  REFUSE_INPUT("magnitude is empty; give the names of two datasets or more, u,v,w, or NULL", i.magnitude = "");
  REFUSE_INPUT("missing is \"\", it must be a number or nan", i.missing = "");
  REFUSE_INPUT("origin is set, and has_origin is 0; set it", i.origin[0] = 1);
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_convert_file(path_of("x.raw"), NULL, NULL, path_of("a.nvdb"), &error));
}

/* A remedy names what the program has to set. */
static void enumerators(void) {
  const char* const input = path_of("v_2x2x2_uint8.raw");
  FILE* const file = fopen(input, "wb");
  CHECK(file != NULL && fwrite("12345678", 1, 8, file) == 8 && fclose(file) == 0);
  char wanted[1024];
  weir_input_options i;
  weir_input_options_init(&i, sizeof i);
  i.missing_chunks = WEIR_MISSING_CHUNKS_ERROR;
  snprintf(wanted, sizeof wanted,
           "%s: WEIR_MISSING_CHUNKS_ERROR is for Zarr arrays and HDF5 files, and this is raw; leave it out", input);
  CHECK_USAGE(wanted, weir_convert_file(input, &i, NULL, path_of("a.nvdb"), &error));
}

static void grids(void) {
  weir_buffer* buffer = NULL;
  weir_grid* grid = NULL;
  CHECK_OK(weir_convert_to_memory(&volume, values, NULL, NULL, &buffer, &error));
  CHECK_OK(weir_open_memory(weir_buffer_data(buffer), weir_buffer_size(buffer), NULL, &grid, &error));
  weir_grid_info info;
  const int64_t lo[3] = {0, 0, 0};
  const int64_t hi[3] = {1, 1, 2};
  const int64_t far[3] = {1, 1, INT64_MAX};
  const int64_t lowest[3] = {-((int64_t)1 << 31), -((int64_t)1 << 31), -((int64_t)1 << 31)};
  const int64_t farthest[3] = {(int64_t)1 << 31, (int64_t)1 << 31, (int64_t)1 << 31};
  float two[2] = {-1, -1};
  weir_grid_info_init(&info, sizeof info);
  CHECK_USAGE("grid is a null pointer", weir_get_info(NULL, &info, &error));
  CHECK_USAGE("weir_grid_info is a null pointer", weir_get_info(grid, NULL, &error));
  info.struct_size = 0;
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_get_info(grid, &info, &error));
  CHECK_USAGE("index is a null pointer", weir_value(grid, NULL, two, &error));
  CHECK_USAGE("value is a null pointer", weir_value(grid, lo, NULL, &error));
  CHECK_USAGE("grid is a null pointer", weir_value(NULL, lo, two, &error));
  CHECK_USAGE("min is a null pointer", weir_read_box(grid, NULL, hi, two, 2, &error));
  CHECK_USAGE("max is a null pointer", weir_read_box(grid, lo, NULL, two, 2, &error));
  CHECK_USAGE("values is a null pointer", weir_read_box(grid, lo, hi, NULL, 2, &error));
  CHECK_USAGE("count is 3, and the box 0:1,0:1,0:2 has 1x1x2 voxels", weir_read_box(grid, lo, hi, two, 3, &error));
  CHECK_USAGE("the box is 0:0,0:0,0:0; it must hold a voxel along each axis, from -2^31 to 2^31",
              weir_read_box(grid, lo, lo, two, 0, &error));
  CHECK_USAGE("the box is 0:1,0:1,0:9223372036854775807; it must hold a voxel along each axis, from -2^31 to 2^31",
              weir_read_box(grid, lo, far, two, 2, &error));
  /* 2^93 and 2^96 voxels are 0 modulo 2^64. */
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_read_box(grid, lo, farthest, two, 0, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_read_box(grid, lowest, farthest, two, 0, &error));
  CHECK_USAGE("filter is 2, it must be WEIR_FILTER_NEAREST or _TRILINEAR", weir_sample(grid, 2, two, 0, two, &error));
  CHECK_USAGE("positions is a null pointer", weir_sample(grid, 0, NULL, 1, two, &error));
  CHECK_USAGE("values is a null pointer", weir_sample(grid, 0, two, 1, NULL, &error));
  CHECK_USAGE("grid is a null pointer", weir_sample(NULL, 0, two, 1, two, &error));
  CHECK(two[0] == -1 && two[1] == -1);
  weir_close(grid);
  weir_buffer_free(buffer);
}

/* A message that is longer than its place keeps its end, with the cause and what to do. */
static void long_messages(void) {
  static const char kEnd[] = "aaa: cannot open: File name too long; choose a shorter name";
  static char path[5000];
  memset(path, 'a', sizeof path - 1);
  weir_grid* grid = NULL;
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_open(path, &grid, &error));
  CHECK(strlen(error.message) == WEIR_MESSAGE_BYTES - 1);
  CHECK(strncmp(error.message, path, 500) == 0 && strstr(error.message, "a...a") != NULL);
  CHECK_TEXT(kEnd, error.message + strlen(error.message) - strlen(kEnd));
}

int main(void) {
  make_directory();
  values = pattern_floats();
  volume = pattern_volume(WEIR_FLOAT32);
  null_pointers();
  struct_sizes();
  volumes();
  options();
  inputs();
  enumerators();
  grids();
  long_messages();
  free(values);
  return finish();
}
