/* Calls on a machine that gives no more: threads. Each is tried in a child of its own, because limits stay. */
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

int main(void) {
  make_directory();
  volume = pattern_volume(WEIR_FLOAT32);
  values = pattern_floats();
  if (!SANITIZED) {
    in_a_child(no_threads);
  }
  free(values);
  return finish();
}
