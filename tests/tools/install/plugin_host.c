/* plugin_host LIBRARY OUTPUT: loads weir's library, converts and unloads it, three times. */
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "weir.h"

/* Data pointers are what dlsym gives. */
#define LOOK_UP(library, name)                    \
  do {                                            \
    void* const found_ = dlsym(library, #name);   \
    memcpy(&name##_there, &found_, sizeof found_); \
  } while (0)

static float values[64 * 64 * 64];

int main(int count, char** arguments) {
  if (count != 3) return 2;
  for (int i = 0; i < 64 * 64 * 64; ++i) values[i] = (float)(i % 1009);
  int done = 0;
  for (; done < 3; ++done) {
    void* const library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
      fprintf(stderr, "%s\n", dlerror());
      return 1;
    }
    weir_status (*weir_volume_init_there)(weir_volume*, size_t) = NULL;
    weir_status (*weir_convert_options_init_there)(weir_convert_options*, size_t) = NULL;
    weir_status (*weir_convert_there)(const weir_volume*, const void*, const int64_t[3], const weir_convert_options*,
                                      const char*, weir_error*) = NULL;
    LOOK_UP(library, weir_volume_init);
    LOOK_UP(library, weir_convert_options_init);
    LOOK_UP(library, weir_convert);
    weir_volume volume;
    weir_convert_options options;
    weir_error error;
    if (weir_volume_init_there(&volume, sizeof volume) != WEIR_OK ||
        weir_convert_options_init_there(&options, sizeof options) != WEIR_OK) {
      return 1;
    }
    volume.type = WEIR_FLOAT32;
    for (int axis = 0; axis < 3; ++axis) volume.extent[axis] = 64;
    options.overwrite = 1;
    options.threads = 2;
    if (weir_convert_there(&volume, values, NULL, &options, arguments[2], &error) != WEIR_OK) {
      fprintf(stderr, "%s\n", error.message);
      return 1;
    }
    dlclose(library);
    usleep(20000);
  }
  printf("%d conversions\n", done);
  return 0;
}
