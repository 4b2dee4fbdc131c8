/* Random sequences of calls with good and bad arguments, by a seed that is printed where something is wrong: nothing
 * may crash, every status is one of weir.h's, every failure has its line, and what succeeds holds. A number as
 * argument: so many sequences instead of a few. */
#include "check.h"

#include <math.h>

enum { HANDLES = 3, CALLS = 40, EXTENT = 20 };

static uint64_t state;

static uint64_t next(void) { /* xorshift64* (Vigna, 2016) */
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return state * UINT64_C(2685821657736338717);
}
static int below(int n) { return (int)(next() >> 33) % n; }

/* Of every third call some arguments are not the sensible ones but at an edge. */
static int spoiled;
static int spoil(int n) { return spoiled && below(n) == 0; }

static int64_t integer(int64_t sensible) {
  static const int64_t edges[] = {0, -1, 1, 2, 7, 8, 255, INT32_MAX, INT32_MIN, INT64_MAX, INT64_MIN, (int64_t)1 << 31};
  return !spoil(6) ? sensible : edges[below((int)(sizeof edges / sizeof edges[0]))];
}
static int32_t small(int n) { return !spoil(9) ? below(n) : (int32_t)integer(INT32_MIN); }
static double real(double sensible) {
  static const double edges[] = {0, -1, 1e300, -1e300, 1e-300, 0.5};
  const int which = spoil(6) ? below(8) : 8;
  return which == 0 ? NAN : which == 1 ? INFINITY : which < 8 ? edges[which - 2] : sensible;
}
/* NULL now and then. */
#define MAYBE(pointer) (spoil(8) ? NULL : (pointer))

static float values[EXTENT * EXTENT * (EXTENT + 1)];
static weir_push* pushes[HANDLES];
static int64_t planes[HANDLES], given[HANDLES];
static weir_buffer* buffers[HANDLES];
static weir_grid* grids[HANDLES];
static int grid_of_buffer[HANDLES];
static int conversions, ended_pushes, readings; /* that succeeded */

static weir_volume random_volume(void) {
  weir_volume volume;
  weir_volume_init(&volume, sizeof volume);
  for (int a = 0; a < 3; ++a) {
    volume.extent[a] = 1 + below(EXTENT);
    if (spoil(9)) volume.extent[a] = below(2) == 0 ? 0 : INT64_MIN;
    volume.spacing[a] = real(1);
    volume.origin[a] = real(0);
  }
  /* No type is wider than the float32 there are bytes of. */
  static const int32_t types[] = {WEIR_UINT8,   WEIR_INT8, WEIR_UINT16, WEIR_INT16, WEIR_FLOAT16,
                                  WEIR_FLOAT32, 0,         99,          -1};
  volume.type = types[below(spoiled ? 9 : 6)];
  static const char* const names[] = {NULL, "", "density", "\xff\xfe"};
  volume.name = names[below(4)];
  static const char* const missing[] = {NULL, NULL, "-9999", "nan", "0", "", "x"};
  volume.missing = missing[spoil(4) ? below(7) : 0];
  if (spoil(9)) volume.struct_size = (size_t)integer(3);
  return volume;
}

static void ignore_progress(void* user, const char* pass, uint64_t done, uint64_t total) {
  (void)user;
  if (pass == NULL || done > total) abort();
}
static int maybe_cancel(void* user) {
  (void)user;
  static int calls = 0; /* conversions of several pushes ask at once */
  return __sync_fetch_and_add(&calls, 1) % 50 == 0;
}

static weir_convert_options random_options(void) {
  weir_convert_options options = default_options();
  options.budget_kind = small(6);
  if (options.budget_kind == WEIR_BUDGET_SIZE) {
    options.size = (uint64_t)integer(700000);
    if (options.size > 1000000) options.size = 1000000; /* a file of 2^63 bytes is a sparse file, or a full disk */
  } else if (options.budget_kind == WEIR_BUDGET_RATE) {
    options.budget = real(0.25 + below(8));
    if (options.budget > 0 && options.budget < 0.01) options.budget = 0.5;
  } else if (options.budget_kind != WEIR_BUDGET_AUTO && options.budget_kind != WEIR_BUDGET_LOSSLESS) {
    options.budget = real(below(60));
  }
  options.encoding = small(6);
  options.metric = below(3) > 0 || options.budget_kind > WEIR_BUDGET_SIZE ? WEIR_METRIC_SSE : small(4);
  options.fill = small(2);
  options.nonfinite = small(3);
  options.brick = spoil(4) ? small(40) : 0;
  options.threads = !spoil(4) ? 0 : below(2) == 0 ? -1 : 5000;
  options.memory = (uint64_t)integer((int64_t)100 << 20);
  options.overwrite = below(4) > 0;
  if (below(4) == 0) options.progress = ignore_progress;
  if (below(8) == 0) options.cancel = maybe_cancel;
  if (spoil(9)) options.struct_size = (size_t)integer(3);
  return options;
}

static const char* random_path(void) {
  static const char* const names[] = {"a.nvdb", "b.nvdb", "none/c.nvdb", ""};
  if (spoil(6)) return NULL;
  return path_of(names[spoil(3) ? 2 + below(2) : below(2)]);
}

static void check_status(weir_status status, const weir_error* error) {
  const int known = (status >= WEIR_OK && status <= WEIR_ERROR_IO) || status == WEIR_INTERRUPTED;
  CHECK(known && status != WEIR_ERROR_INTERNAL);
  CHECK(error->status == status && (status == WEIR_OK) == (error->message[0] == 0));
  CHECK(strchr(error->message, '\n') == NULL);
  if (failures > 0) {
    fprintf(stderr, "status %d: %s\n", (int)status, error->message);
    exit(finish());
  }
}

static weir_status convert_call(weir_error* error, int slot) {
  const weir_volume volume = random_volume();
  const weir_convert_options options = random_options();
  int64_t stride[3] = {4, 0, -4};
  stride[below(3)] = below(3);
  const void* const data = MAYBE(values + EXTENT * EXTENT);
  const int64_t* const layout = below(6) > 0 ? NULL : stride;
  switch (below(3)) {
    case 0:
      return weir_convert(MAYBE(&volume), data, layout, MAYBE(&options), random_path(), error);
    case 1:
      return weir_convert_file(random_path(), NULL, MAYBE(&options), random_path(), error);
    default:
      if (buffers[slot] != NULL) return weir_open(NULL, NULL, error);
      return weir_convert_to_memory(MAYBE(&volume), data, layout, MAYBE(&options), MAYBE(&buffers[slot]), error);
  }
}

static weir_status push_call(weir_error* error, int slot) {
  weir_push** const push = &pushes[slot];
  if (*push == NULL && below(4) > 0) {
    const weir_volume volume = random_volume();
    const weir_convert_options options = random_options();
    planes[slot] = volume.extent[2];
    given[slot] = 0;
    return weir_push_begin(MAYBE(&volume), MAYBE(&options), random_path(), MAYBE(push), error);
  }
  if (spoil(8)) {
    weir_push_free(*push);
    *push = NULL;
  }
  if (given[slot] >= planes[slot] || spoil(8)) {
    const weir_status status = weir_push_end(*push, error);
    ended_pushes += status == WEIR_OK;
    if (!spoil(2)) {
      weir_push_free(*push);
      *push = NULL;
    }
    return status;
  }
  const int64_t left = planes[slot] - given[slot];
  const int64_t nz = left > 8 ? 8 : left;
  const weir_status status = weir_push_slab(*push, integer(given[slot]), integer(nz), MAYBE(values), NULL, error);
  if (status == WEIR_OK) given[slot] += nz;
  return status;
}

static weir_status grid_call(weir_error* error, int slot) {
  weir_grid** const grid = &grids[slot];
  if (*grid == NULL) {
    const int b = below(HANDLES);
    grid_of_buffer[slot] = -1;
    if (below(2) == 0 || buffers[b] == NULL) return weir_open(random_path(), MAYBE(grid), error);
    uint64_t bytes = weir_buffer_size(buffers[b]);
    if (spoil(3)) bytes = (uint64_t)below((int)bytes);
    grid_of_buffer[slot] = b;
    return weir_open_memory(MAYBE(weir_buffer_data(buffers[b])), bytes, MAYBE(weir_buffer_sidecar(buffers[b])),
                            MAYBE(grid), error);
  }
  const int64_t lo[3] = {integer(below(9)), integer(below(9)), integer(below(9))};
  const int64_t hi[3] = {integer(lo[0] < 99 && lo[0] > -9 ? lo[0] + 5 : 5), integer(8), integer(9)};
  float out[512];
  switch (below(5)) {
    case 0:
      weir_close(*grid);
      *grid = NULL;
      return weir_value(*grid, lo, out, error);
    case 1:
      return weir_value(*grid, MAYBE(lo), MAYBE(out), error);
    case 2: {
      const size_t count = 5 * (8 - (size_t)lo[1]) * (9 - (size_t)lo[2]);
      return weir_read_box(*grid, MAYBE(lo), MAYBE(hi), MAYBE(out), count <= 512 ? count : 512, error);
    }
    case 3: {
      float at[30];
      for (int i = 0; i < 30; ++i) at[i] = (float)real(below(40) - 10);
      return weir_sample(*grid, small(2), MAYBE(at), 10, MAYBE(out), error);
    }
    default: {
      weir_grid_info info;
      weir_grid_info_init(&info, sizeof info);
      if (spoil(3)) info.struct_size = (size_t)integer(0);
      return weir_get_info(*grid, MAYBE(&info), error);
    }
  }
}

static void free_buffer(int slot) {
  for (int g = 0; g < HANDLES; ++g) {
    if (grids[g] == NULL || grid_of_buffer[g] != slot) continue;
    weir_close(grids[g]);
    grids[g] = NULL;
  }
  weir_buffer_free(buffers[slot]);
  buffers[slot] = NULL;
}

static void run_sequence(uint64_t seed) {
  state = seed * UINT64_C(0x9E3779B97F4A7C15) + 1;
  weir_error error;
  for (int call = 0; call < CALLS; ++call) {
    const int slot = below(HANDLES);
    spoiled = below(3) == 0;
    memset(&error, 'x', sizeof error);
    weir_status status = WEIR_OK;
    switch (below(4)) {
      case 0:
        status = convert_call(&error, slot);
        conversions += status == WEIR_OK;
        break;
      case 1:
        status = grid_call(&error, slot);
        readings += status == WEIR_OK;
        break;
      case 2:
        if (below(6) == 0) free_buffer(slot);
        status = grid_call(&error, slot);
        break;
      default:
        status = push_call(&error, slot);
    }
    check_status(status, &error);
  }
  for (int slot = 0; slot < HANDLES; ++slot) {
    weir_push_free(pushes[slot]);
    pushes[slot] = NULL;
    weir_close(grids[slot]);
    grids[slot] = NULL;
  }
  for (int slot = 0; slot < HANDLES; ++slot) free_buffer(slot);
}

int main(int argc, char** argv) {
  const int sequences = argc > 1 ? atoi(argv[1]) : 40;
  make_directory();
  for (int i = 0; i < EXTENT * EXTENT * (EXTENT + 1); ++i) values[i] = (float)(i % 71);
  for (int seed = 1; seed <= sequences; ++seed) {
    const int before = failures;
    run_sequence((uint64_t)seed);
    if (failures > before) fprintf(stderr, "seed %d\n", seed);
  }
  /* Else it would not be about much. */
  printf("%d conversions, %d readings and %d pushes succeeded\n", conversions, readings, ended_pushes);
  CHECK(conversions >= sequences && readings >= 2 * sequences && ended_pushes >= sequences / 4);
  return finish();
}
