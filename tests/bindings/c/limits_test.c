/* Calls on a machine that gives no more: threads, bytes of a file, open files, memory, stack. Each is tried in a child
 * of its own, because limits stay. */
#include "check.h"

#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

static weir_error error;
static weir_volume volume;
static float* values;

static void in_a_child(void (*test)(void)) {
  const pid_t child = fork();
  if (child == 0) {
    failures = 0;
    test();
    _exit(failures == 0 ? 0 : 1);
  }
  int status = 0;
  CHECK(child > 0 && waitpid(child, &status, 0) == child);
  if (WIFSIGNALED(status)) fprintf(stderr, "ended by signal %d\n", WTERMSIG(status));
  CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

static int limit(int resource, rlim_t most) {
  const struct rlimit limits = {most, most};
  return setrlimit(resource, &limits) == 0;
}

static int ends_with(const char* text, const char* end) {
  const size_t length = strlen(text);
  return length >= strlen(end) && strcmp(text + length - strlen(end), end) == 0;
}

#define CHECK_END(wanted, found)                                                                       \
  do {                                                                                                 \
    if (!ends_with((found), (wanted))) {                                                               \
      ++failures;                                                                                      \
      fprintf(stderr, "%s:%d: expected \"...%s\", found \"%s\"\n", __FILE__, __LINE__, wanted, found); \
    }                                                                                                  \
  } while (0)

static void no_threads(void) {
  static const char kMessage[] =
      "no more threads can be started; raise the limit of processes (ulimit -u) or of address space (ulimit -v), or "
      "end some";
  chmod(directory, 0777);
  CHECK(limit(RLIMIT_NPROC, 1));
  if (geteuid() == 0 && setuid(65534) != 0) { /* root may start any number */
    perror("no thread limit is tested: setuid");
    return;
  }
  weir_push* push = NULL;
  CHECK_STATUS(WEIR_ERROR_IO, weir_push_begin(&volume, NULL, path_of("a.nvdb"), &push, &error));
  CHECK_TEXT(kMessage, error.message);
  CHECK(push == NULL && !exists(path_of("a.nvdb.partial")));
  CHECK_STATUS(WEIR_ERROR_IO, weir_convert(&volume, values, NULL, NULL, path_of("a.nvdb"), &error));
  CHECK_TEXT(kMessage, error.message);
}

/* In a file of 16 KiB no volume has room. The signal, whose default ends the program, must neither come nor be changed.
 */
static void small_files(void) {
  static const char kRemedy[] =
      ": File too large; raise the limit of file size (ulimit -f) or choose another file system";
  struct sigaction before;
  struct sigaction after;
  CHECK(sigaction(SIGXFSZ, NULL, &before) == 0 && before.sa_handler == SIG_DFL);
  CHECK(limit(RLIMIT_FSIZE, 16384));
  weir_convert_options options = default_options();
  options.budget_kind = WEIR_BUDGET_LOSSLESS;
  CHECK_STATUS(WEIR_ERROR_IO, weir_convert(&volume, values, NULL, &options, path_of("b.nvdb"), &error));
  CHECK_END(kRemedy, error.message);
  weir_push* push = NULL;
  CHECK_OK(weir_push_begin(&volume, &options, path_of("b.nvdb"), &push, &error));
  weir_status status = weir_push_slab(push, 0, NZ, values, NULL, &error);
  if (status == WEIR_OK) status = weir_push_end(push, &error);
  CHECK(status == WEIR_ERROR_IO);
  CHECK_END(kRemedy, error.message);
  weir_push_free(push);
  CHECK(!exists(path_of("b.nvdb")) && !exists(path_of("b.nvdb.partial")));
  sigset_t signals;
  CHECK(sigaction(SIGXFSZ, NULL, &after) == 0 && after.sa_handler == SIG_DFL);
  CHECK(sigpending(&signals) == 0 && sigismember(&signals, SIGXFSZ) == 0);
  CHECK(pthread_sigmask(SIG_BLOCK, NULL, &signals) == 0 && sigismember(&signals, SIGXFSZ) == 0);
}

static void few_files(void) {
  CHECK(limit(RLIMIT_NOFILE, 3));
  CHECK_STATUS(WEIR_ERROR_IO, weir_convert(&volume, values, NULL, NULL, path_of("c.nvdb"), &error));
  CHECK_END(": Too many open files; raise the limit of open files (ulimit -n)", error.message);
}

/* A file larger than the address space; all values are one voxel. */
static void little_memory(void) {
  weir_volume large = volume;
  large.extent[0] = large.extent[1] = large.extent[2] = 300;
  const int64_t stride[3] = {0, 0, 0};
  weir_convert_options options = default_options();
  options.encoding = WEIR_ENCODING_FLOAT;
  options.budget_kind = WEIR_BUDGET_RATE;
  options.budget = 0.125;
  options.threads = 1;
  CHECK(limit(RLIMIT_AS, 800U << 20U));
  weir_buffer* buffer = NULL;
  CHECK_STATUS(WEIR_ERROR_INTERNAL, weir_convert_to_memory(&large, values, stride, &options, &buffer, &error));
  CHECK_TEXT("out of memory: a file made in it needs 864002048 bytes; free some, or ask for a smaller file",
             error.message);
  CHECK(buffer == NULL);
}

/* What weir.h asks for. */
enum { STACK_BYTES = 256 << 10 };

static void* convert_all(void* unused) {
  static const int32_t kEncodings[] = {WEIR_ENCODING_AUTO, WEIR_ENCODING_FLOAT, WEIR_ENCODING_FPN,
                                       WEIR_ENCODING_PACKED};
  weir_convert_options options = default_options();
  options.overwrite = 1;
  options.threads = 1; /* so that this thread does all of it */
  for (size_t i = 0; i < sizeof kEncodings / sizeof *kEncodings; ++i) {
    options.encoding = kEncodings[i];
    CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("d.nvdb"), &error));
    weir_buffer* buffer = NULL;
    CHECK_OK(weir_convert_to_memory(&volume, values, NULL, &options, &buffer, &error));
    weir_buffer_free(buffer);
    weir_push* push = NULL;
    CHECK_OK(weir_push_begin(&volume, &options, path_of("e.nvdb"), &push, &error));
    CHECK_OK(weir_push_slab(push, 0, NZ, values, NULL, &error));
    CHECK_OK(weir_push_end(push, &error));
    weir_push_free(push);
    CHECK(same_files(path_of("d.nvdb"), path_of("e.nvdb")));
    CHECK_OK(weir_convert_file(path_of("d.nvdb"), NULL, &options, path_of("f.nvdb"), &error));
    weir_grid* grid = NULL;
    CHECK_OK(weir_open(path_of("d.nvdb"), &grid, &error));
    const float position[3] = {NX / 2, NY / 2, NZ / 2};
    float value = 0;
    CHECK_OK(weir_sample(grid, WEIR_FILTER_TRILINEAR, position, 1, &value, &error));
    weir_close(grid);
  }
  return unused;
}

static void small_stack(void) {
  pthread_attr_t attributes;
  pthread_t thread;
  CHECK(pthread_attr_init(&attributes) == 0);
  CHECK(pthread_attr_setstacksize(&attributes, STACK_BYTES) == 0);
  CHECK(pthread_create(&thread, &attributes, convert_all, NULL) == 0);
  CHECK(pthread_join(thread, NULL) == 0);
  pthread_attr_destroy(&attributes);
}

int main(void) {
  make_directory();
  volume = pattern_volume(WEIR_FLOAT32);
  values = pattern_floats();
  if (!SANITIZED) {
    in_a_child(no_threads);
    in_a_child(small_files);
    in_a_child(few_files);
    in_a_child(little_memory);
    in_a_child(small_stack);
  }
  free(values);
  return finish();
}
