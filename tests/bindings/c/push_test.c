/* Volumes handed over in slabs: in any order, type and layout, by many threads, and what is out of order. */
#include "check.h"

#include <pthread.h>
#include <sys/stat.h>
#include <sys/wait.h>

static weir_error error;

static weir_push* begin(const weir_volume* volume, const char* output) {
  weir_push* push = NULL;
  weir_convert_options options = default_options();
  options.overwrite = 1;
  CHECK_OK(weir_push_begin(volume, &options, output, &push, &error));
  return push;
}

static void convert(const weir_volume* volume, const void* values, const char* output) {
  weir_convert_options options = default_options();
  options.overwrite = 1;
  CHECK_OK(weir_convert(volume, values, NULL, &options, output, &error));
}

static void any_order(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  convert(&volume, values, path_of("whole.nvdb"));
  weir_push* const push = begin(&volume, path_of("pushed.nvdb"));
  float* const slab = malloc(sizeof(float) * NX * NY * 5);
  for (int z = NZ - 3; z > -5; z -= 5) { /* from the top, the lowest one thinner */
    const int first = z < 0 ? 0 : z;
    const int planes = (z == NZ - 3 ? NZ : z + 5) - first;
    memcpy(slab, values + NX * NY * first, sizeof(float) * (size_t)(NX * NY * planes));
    CHECK_OK(weir_push_slab(push, first, planes, slab, NULL, &error));
    memset(slab, 0xFF, sizeof(float) * NX * NY * 5); /* what the simulation does next */
  }
  CHECK(!exists(path_of("pushed.nvdb")));
  CHECK_OK(weir_push_end(push, &error));
  weir_push_free(push);
  CHECK(same_files(path_of("whole.nvdb"), path_of("pushed.nvdb")));
  CHECK(exists(path_of("pushed.nvdb.json")) && !exists(path_of(".pushed.nvdb.work")));
  free(slab);
}

static void any_layout(void) {
  int16_t* const values = malloc(sizeof(int16_t) * VOXELS);
  int16_t* const transposed = malloc(sizeof(int16_t) * VOXELS); /* z fastest */
  for (int z = 0; z < NZ; ++z) {
    for (int y = 0; y < NY; ++y) {
      for (int x = 0; x < NX; ++x) {
        values[x + NX * (y + NY * z)] = (int16_t)pattern(x, y, z);
        transposed[z + NZ * (y + NY * x)] = (int16_t)pattern(x, y, z);
      }
    }
  }
  const weir_volume volume = pattern_volume(WEIR_INT16);
  convert(&volume, values, path_of("whole.nvdb"));
  weir_push* const push = begin(&volume, path_of("pushed.nvdb"));
  const int64_t stride[3] = {2 * NZ * NY, 2 * NZ, 2};
  for (int z = 0; z < NZ; ++z) CHECK_OK(weir_push_slab(push, z, 1, transposed + z, stride, &error));
  CHECK_OK(weir_push_end(push, &error));
  weir_push_free(push);
  CHECK(same_files(path_of("whole.nvdb"), path_of("pushed.nvdb")));
  free(values);
  free(transposed);
}

enum { THREADS = 4 };

struct worker {
  weir_push* push;
  const float* values;
  int first;
  weir_status status;
};

static void* push_planes(void* argument) {
  struct worker* const worker = argument;
  for (int z = worker->first; z < NZ && worker->status == WEIR_OK; z += THREADS) {
    worker->status = weir_push_slab(worker->push, z, 1, worker->values + NX * NY * z, NULL, NULL);
  }
  return NULL;
}

static void many_threads(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  convert(&volume, values, path_of("whole.nvdb"));
  weir_push* const push = begin(&volume, path_of("pushed.nvdb"));
  struct worker workers[THREADS];
  pthread_t threads[THREADS];
  for (int t = 0; t < THREADS; ++t) {
    workers[t] = (struct worker){push, values, t, WEIR_OK};
    CHECK(pthread_create(&threads[t], NULL, push_planes, &workers[t]) == 0);
  }
  for (int t = 0; t < THREADS; ++t) {
    pthread_join(threads[t], NULL);
    CHECK(workers[t].status == WEIR_OK);
  }
  CHECK_OK(weir_push_end(push, &error));
  weir_push_free(push);
  CHECK(same_files(path_of("whole.nvdb"), path_of("pushed.nvdb")));
}

static void out_of_order(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  const char* const output = path_of("order.nvdb");
  weir_push* push = begin(&volume, output);
  weir_push* second = NULL;
  CHECK_STATUS(WEIR_ERROR_IO, weir_push_begin(&volume, NULL, output, &second, &error)); /* the same output */
  CHECK(strstr(error.message, ".partial: is being written by another process or conversion; wait for it"));
  CHECK(second == NULL);
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_end(push, &error)); /* nothing was given */
  const int64_t too_far[3] = {4, 4 * NX, INT64_MAX / 4};
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_slab(push, 0, NZ - 1, values, too_far, &error));
  CHECK(strstr(error.message, "memory: a stride of 2305843009213693951 bytes along z for ") == error.message);
  CHECK_OK(weir_push_slab(push, 0, NZ - 1, values, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_slab(push, 3, 1, values, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_slab(push, NZ - 2, 2, values, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_slab(push, NZ - 1, 2, values, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_slab(push, -1, 1, values, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_slab(push, NZ - 1, 0, values, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_slab(push, INT64_MAX, INT64_MAX, values, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_slab(push, 0, INT64_MAX, values, NULL, &error));
  CHECK(strstr(error.message, " planes from 0 on is not in the volume, whose planes are 0 to ") != NULL);
  CHECK_USAGE("memory: the slab's data is a null pointer", weir_push_slab(push, NZ - 1, 1, NULL, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_USAGE, weir_push_end(push, &error)); /* a plane is missing, and can still be given */
  CHECK_OK(weir_push_slab(push, NZ - 1, 1, values + NX * NY * (NZ - 1), NULL, &error));
  CHECK_OK(weir_push_end(push, &error));
  CHECK_USAGE("memory: the volume has ended; begin another one", weir_push_end(push, &error));
  CHECK_USAGE("memory: the volume has ended; begin another one", weir_push_slab(push, 0, 1, values, NULL, &error));
  weir_push_free(push);
  CHECK(same_files(path_of("whole.nvdb"), path_of("order.nvdb")));

  /* Without an end there is nothing. */
  push = begin(&volume, path_of("never.nvdb"));
  CHECK_OK(weir_push_slab(push, 0, NZ / 2, values, NULL, &error));
  weir_push_free(push);
  push = begin(&volume, path_of("never.nvdb"));
  weir_push_free(push);
  CHECK(!exists(path_of("never.nvdb")) && !exists(path_of("never.nvdb.json")));
  CHECK(!exists(path_of("never.nvdb.partial")) && !exists(path_of(".never.nvdb.work")));
}

static int cancel(void* user) { return *(int*)user; }

static void after_a_failure(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  float* const holed = malloc(sizeof(float) * VOXELS);
  memcpy(holed, values, sizeof(float) * VOXELS);
  holed[1000] = 1.0F / 0.0F;
  weir_push* push = begin(&volume, path_of("failed.nvdb"));
  CHECK_OK(weir_push_slab(push, 0, NZ, holed, NULL, &error));
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_push_end(push, &error));
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_push_end(push, &error));
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_push_slab(push, 0, 1, values, NULL, &error));
  weir_push_free(push);
  CHECK(!exists(path_of("failed.nvdb")) && !exists(path_of("failed.nvdb.partial")));
  free(holed);

  int stop = 0;
  weir_convert_options options = default_options();
  options.cancel = cancel;
  options.user = &stop;
  CHECK_OK(weir_push_begin(&volume, &options, path_of("stopped.nvdb"), &push, &error));
  CHECK_OK(weir_push_slab(push, 0, 1, values, NULL, &error));
  stop = 1;
  CHECK_STATUS(WEIR_INTERRUPTED, weir_push_slab(push, 1, NZ - 1, values + NX * NY, NULL, &error));
  CHECK_STATUS(WEIR_INTERRUPTED, weir_push_end(push, &error));
  weir_push_free(push);
  CHECK(!exists(path_of("stopped.nvdb")) && !exists(path_of("stopped.nvdb.partial")));
}

/* A relative output is the file that it named at the begin, wherever the program has gone since. */
static void after_a_change_of_directory(const float* values) {
  char before[4096];
  CHECK(getcwd(before, sizeof before) != NULL);
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  convert(&volume, values, path_of("whole.nvdb"));
  CHECK(mkdir(path_of("here"), 0700) == 0 && mkdir(path_of("there"), 0700) == 0);
  CHECK(chdir(path_of("here")) == 0);
  weir_push* const ended = begin(&volume, "step.nvdb");
  weir_push* const freed = begin(&volume, "freed.nvdb");
  CHECK_OK(weir_push_slab(ended, 0, NZ, values, NULL, &error));
  CHECK(chdir(path_of("there")) == 0);
  FILE* const other = fopen("freed.nvdb.partial", "w");
  CHECK(other != NULL && fclose(other) == 0);
  CHECK_OK(weir_push_end(ended, &error));
  weir_push_free(ended);
  weir_push_free(freed);
  CHECK(same_files(path_of("whole.nvdb"), path_of("here/step.nvdb")));
  CHECK(exists(path_of("here/step.nvdb.json")) && !exists(path_of("here/freed.nvdb.partial")));
  CHECK(!exists(path_of("there/step.nvdb")) && exists(path_of("there/freed.nvdb.partial")));
  CHECK(chdir(before) == 0);
}

enum { NOT_FORKED = -1 };

/* Forks once, and converts and begins a push in the child; *user becomes its exit status. */
static void convert_in_a_child(void* user, const char* pass, uint64_t done, uint64_t total) {
  (void)pass;
  (void)done;
  (void)total;
  int* const status = user;
  if (*status != NOT_FORKED) return;
  const pid_t child = fork();
  if (child != 0) {
    CHECK(child > 0 && waitpid(child, status, 0) == child);
    return;
  }
  const float one = 1;
  weir_volume volume = pattern_volume(WEIR_FLOAT32);
  volume.extent[0] = volume.extent[1] = volume.extent[2] = 1;
  failures = 0;
  const char* const refused =
      "this process was forked while its parent converted or rendered, and has none of the threads for it; start it "
      "by exec (in Python: multiprocessing with \"spawn\"), or fork it before";
  CHECK_USAGE(refused, weir_convert(&volume, &one, NULL, NULL, path_of("child.nvdb"), &error));
  weir_push* push = NULL;
  CHECK_USAGE(refused, weir_push_begin(&volume, NULL, path_of("child.nvdb"), &push, &error));
  CHECK(!exists(path_of("child.nvdb")) && !exists(path_of("child.nvdb.partial")));
  _exit(failures == 0 ? 0 : 1);
}

static void forked(const float* values) {
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  weir_convert_options options = default_options();
  options.overwrite = 1;
  int status = NOT_FORKED;
  options.progress = convert_in_a_child;
  options.user = &status;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("parent.nvdb"), &error));
  CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);

#if !defined(__SANITIZE_THREAD__) /* which lets no child start threads */
  /* Between conversions a child has what it needs. */
  const pid_t child = fork();
  if (child == 0)
    _exit(weir_convert(&volume, values, NULL, &options, path_of("child.nvdb"), &error) == WEIR_OK ? 0 : 1);
  CHECK(child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0);
  CHECK(same_files(path_of("parent.nvdb"), path_of("child.nvdb")));
#endif
}

int main(void) {
  make_directory();
  float* const values = pattern_floats();
  any_order(values);
  any_layout();
  many_threads(values);
  out_of_order(values);
  after_a_failure(values);
  after_a_change_of_directory(values);
  forked(values);
  free(values);
  return finish();
}
