/* Callers that round otherwise, or in whose programs subnormal numbers are 0, as -ffast-math makes them: the same bytes
 * and values, and their mode afterwards. */
#include "check.h"

#include <fenv.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

static weir_error error;

/* Subnormal numbers, and others. */
static void fill(float* values) {
  for (int i = 0; i < VOXELS; ++i) {
    const uint32_t bits = (uint32_t)i * 2654435761U;
    const uint32_t number = i % 3 == 0 ? bits >> 9U : 0x3F800000U | (bits >> 9U);
    memcpy(values + i, &number, sizeof number);
  }
}

static void convert(const float* values, const char* output, double psnr) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  weir_convert_options options = default_options();
  options.overwrite = 1;
  options.encoding = WEIR_ENCODING_PACKED;
  options.budget_kind = psnr > 0 ? WEIR_BUDGET_PSNR : WEIR_BUDGET_LOSSLESS;
  options.budget = psnr;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, output, &error));
}

static void read_all(const char* path, float* values) {
  weir_grid* grid = NULL;
  CHECK_OK(weir_open(path, &grid, &error));
  const int64_t min[3] = {0, 0, 0};
  const int64_t max[3] = {NX, NY, NZ};
  CHECK_OK(weir_read_box(grid, min, max, values, VOXELS, &error));
  weir_close(grid);
}

static void convert_and_read(const float* source, const char* lossless, const char* lossy, float* values) {
  convert(source, lossless, 0);
  convert(source, lossy, 50);
  read_all(lossless, values);
  read_all(lossy, values + VOXELS);
}

int main(void) {
  make_directory();
  float* const source = malloc(sizeof(float) * VOXELS);
  float* const expected = malloc(sizeof(float) * VOXELS * 2);
  float* const values = malloc(sizeof(float) * VOXELS * 2);
  fill(source);
  convert_and_read(source, path_of("a.nvdb"), path_of("b.nvdb"), expected);
  CHECK(memcmp(source, expected, sizeof(float) * VOXELS) == 0);

  CHECK(fesetround(FE_TOWARDZERO) == 0);
#if defined(__SSE__)
  _mm_setcsr(_mm_getcsr() | 0x8040U); /* flush to zero, and take subnormal numbers for 0 */
  const unsigned mode = _mm_getcsr() & 0xE040U;
#endif
  convert_and_read(source, path_of("c.nvdb"), path_of("d.nvdb"), values);
  CHECK(fegetround() == FE_TOWARDZERO);
#if defined(__SSE__)
  CHECK((_mm_getcsr() & 0xE040U) == mode);
#endif
  CHECK(same_files(path_of("a.nvdb"), path_of("c.nvdb")));
  CHECK(same_files(path_of("b.nvdb"), path_of("d.nvdb")));
  CHECK(memcmp(expected, values, sizeof(float) * VOXELS * 2) == 0);
  free(source);
  free(expected);
  free(values);
  return finish();
}
