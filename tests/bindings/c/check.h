/* What the C tests share: checks that go on after a failure, a directory of the test's own, and a volume. Included
 * first, for it says which POSIX it wants. */
#ifndef WEIR_TESTS_C_CHECK_H
#define WEIR_TESTS_C_CHECK_H

#if defined(__SANITIZE_THREAD__)
#define _GNU_SOURCE
#include <sched.h>
#endif
#define _XOPEN_SOURCE 700

#include <ftw.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "weir.h"

static int failures = 0;

#define CHECK(condition)                                                      \
  do {                                                                        \
    if (!(condition)) {                                                       \
      ++failures;                                                             \
      fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
    }                                                                         \
  } while (0)

/* `call`, which has `error` as its last argument, ends with `wanted`. */
#define CHECK_STATUS(wanted, call)                                                                                 \
  do {                                                                                                             \
    memset(&error, 'x', sizeof error);                                                                             \
    const weir_status status_ = (call);                                                                            \
    if (status_ != (wanted) || error.status != status_ || (status_ == WEIR_OK) != (error.message[0] == 0)) {       \
      ++failures;                                                                                                  \
      fprintf(stderr, "%s:%d: %s is %d, %d: %.200s\n", __FILE__, __LINE__, #call, (int)status_, (int)error.status, \
              error.message);                                                                                      \
    }                                                                                                              \
  } while (0)
#define CHECK_OK(call) CHECK_STATUS(WEIR_OK, call)

#define CHECK_TEXT(wanted, found)                                                                       \
  do {                                                                                                  \
    if (strcmp((wanted), (found)) != 0) {                                                               \
      ++failures;                                                                                       \
      fprintf(stderr, "%s:%d: expected \"%s\", found \"%s\"\n", __FILE__, __LINE__, (wanted), (found)); \
    }                                                                                                   \
  } while (0)

/* The call is refused as a wrong argument with that message. */
#define CHECK_USAGE(wanted, call)         \
  do {                                    \
    CHECK_STATUS(WEIR_ERROR_USAGE, call); \
    CHECK_TEXT(wanted, error.message);    \
  } while (0)

static char directory[256];

static inline void make_directory(void) {
#if defined(__SANITIZE_THREAD__)
  /* It cannot see what TBB, which is not built for it, orders; on one core TBB has no workers, and all other threads
   * run as ever. */
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET((size_t)sched_getcpu(), &one);
  if (sched_setaffinity(0, sizeof one, &one) != 0) perror("sched_setaffinity");
#endif
  const char* const parent = getenv("TMPDIR");
  snprintf(directory, sizeof directory, "%s/weir_c_XXXXXX", parent != NULL ? parent : "/tmp");
  if (mkdtemp(directory) == NULL) {
    perror(directory);
    exit(1);
  }
}

static inline int remove_entry(const char* path, const struct stat* status, int kind, struct FTW* where) {
  (void)status;
  (void)kind;
  (void)where;
  return remove(path);
}

/* The program's exit code. */
static inline int finish(void) {
  if (directory[0] != 0) nftw(directory, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
  return failures == 0 ? 0 : 1;
}

/* The path of a file in the directory; a few of them at a time. */
static inline const char* path_of(const char* name) {
  static char paths[8][512];
  static int next = 0;
  char* const path = paths[next++ % 8];
  snprintf(path, sizeof paths[0], "%s/%s", directory, name);
  return path;
}

static inline int exists(const char* path) { return access(path, F_OK) == 0; }

/* All of a file, for free(); NULL where there is none. */
static inline unsigned char* read_file(const char* path, size_t* bytes) {
  FILE* const file = fopen(path, "rb");
  if (file == NULL) return NULL;
  fseek(file, 0, SEEK_END);
  *bytes = (size_t)ftell(file);
  rewind(file);
  unsigned char* const content = malloc(*bytes + 1);
  if (fread(content, 1, *bytes, file) != *bytes) abort();
  fclose(file);
  return content;
}

static inline int same_files(const char* a, const char* b) {
  size_t bytes_a = 0;
  size_t bytes_b = 0;
  unsigned char* const content_a = read_file(a, &bytes_a);
  unsigned char* const content_b = read_file(b, &bytes_b);
  const int same =
      content_a != NULL && content_b != NULL && bytes_a == bytes_b && memcmp(content_a, content_b, bytes_a) == 0;
  free(content_a);
  free(content_b);
  return same;
}

/* Half of it 0, half a pattern; neither axis a multiple of 8. */
enum { NX = 70, NY = 37, NZ = 43, VOXELS = NX * NY * NZ };

static inline int pattern(int x, int y, int z) { return x < NX / 2 ? 0 : (x * y * 7 + z * z * 13) % 101; }

static inline weir_volume pattern_volume(int32_t type) {
  weir_volume volume;
  weir_volume_init(&volume, sizeof volume);
  volume.extent[0] = NX;
  volume.extent[1] = NY;
  volume.extent[2] = NZ;
  volume.type = type;
  return volume;
}

static inline float* pattern_floats(void) {
  float* const values = malloc(sizeof(float) * VOXELS);
  float* at = values;
  for (int z = 0; z < NZ; ++z) {
    for (int y = 0; y < NY; ++y) {
      for (int x = 0; x < NX; ++x) *at++ = (float)pattern(x, y, z);
    }
  }
  return values;
}

static inline weir_convert_options default_options(void) {
  weir_convert_options options;
  weir_convert_options_init(&options, sizeof options);
  return options;
}

#endif
