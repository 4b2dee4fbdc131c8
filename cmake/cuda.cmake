# Of gpu/cuda/, where nvcc is found: weir_cuda, also called weir::cuda, the grid loader, which another program embeds
# (docs/embedding.md), and weir_cuda_backend, the renderer's kernels and what makes them a back end of weir render.
# At file scope: enable_language does not work inside a function.

set(wanted ${WEIR_CUDA})
if(wanted STREQUAL "AUTO" AND WEIR_EMBED)
  set(wanted ON)
elseif(wanted STREQUAL "AUTO")
  # The kernels take longer to compile than the rest, and without a device nothing runs them.
  execute_process(COMMAND nvidia-smi --list-gpus OUTPUT_VARIABLE devices ERROR_QUIET)
  if(devices MATCHES "GPU")
    set(wanted ON)
  endif()
endif()
if(NOT wanted STREQUAL "ON")
  return()
endif()

include(CheckLanguage)
find_program(WEIR_NVCC nvcc PATHS /usr/local/cuda/bin)
if(WEIR_NVCC AND NOT CMAKE_CUDA_COMPILER)
  set(CMAKE_CUDA_COMPILER ${WEIR_NVCC})
endif()
check_language(CUDA)
if(CMAKE_CUDA_COMPILER)
  if(NOT DEFINED ENV{CUDAARCHS})
    # Machine code for Hopper, and what any newer or older device's driver can compile.
    set(CMAKE_CUDA_ARCHITECTURES 75-virtual 90-real CACHE STRING "Compute capabilities to compile for")
  endif()
  enable_language(CUDA)
  if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)  # CMake 3.25 does not know that nvcc 12 and later have it
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
    set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
    set(CMAKE_CUDA20_STANDARD__HAS_FULL_SUPPORT ON)
  endif()
  set(CMAKE_CUDA_STANDARD 20)
  set(CMAKE_CUDA_STANDARD_REQUIRED ON)
  find_package(CUDAToolkit REQUIRED)
  file(GLOB loader CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/gpu/cuda/load/*.cpp)
  list(APPEND loader ${PROJECT_SOURCE_DIR}/gpu/cuda/runtime/check.cpp ${PROJECT_SOURCE_DIR}/gpu/cuda/grid_loader.cpp)
  add_library(weir_cuda STATIC ${loader})
  add_library(weir::cuda ALIAS weir_cuda)
  set_target_properties(weir_cuda PROPERTIES EXPORT_NAME cuda)
  set(WEIR_CUDA_HEADERS runtime/check runtime/device_array device_buffer grid_loader load/copy_task load/direct_storage load/load_report
                        load/pinned_memory load/pinned_ring load/registered_range load/zero_copy)
  list(TRANSFORM WEIR_CUDA_HEADERS REPLACE ".+" "${PROJECT_SOURCE_DIR}/gpu/cuda/\\0.h")
  target_sources(weir_cuda PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${WEIR_CUDA_HEADERS})
  target_compile_options(weir_cuda INTERFACE $<$<COMPILE_LANGUAGE:CUDA>:-std=c++20>)  # where CMake does not know it
  target_link_libraries(weir_cuda PUBLIC weir_gpu_core CUDA::cudart_static ${CMAKE_DL_LIBS} Threads::Threads)
  target_compile_definitions(weir_cuda PUBLIC WEIR_HAVE_CUDA)
  # Each thread has a default stream of its own: one loads while another renders.
  target_compile_definitions(weir_cuda PRIVATE CUDA_API_PER_THREAD_DEFAULT_STREAM)
  if(NOT WEIR_EMBED)
    file(GLOB_RECURSE renderer CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/gpu/cuda/*.cpp
                                                ${PROJECT_SOURCE_DIR}/gpu/cuda/*.cu)
    list(REMOVE_ITEM renderer ${loader})
    add_library(weir_cuda_backend STATIC ${renderer})
    # A decoded value has its roundings on the device, too.
    set_source_files_properties(${PROJECT_SOURCE_DIR}/gpu/cuda/packed/block_decoder.cu PROPERTIES COMPILE_OPTIONS -fmad=false)
    target_compile_definitions(weir_cuda_backend PRIVATE CUDA_API_PER_THREAD_DEFAULT_STREAM)
    target_link_libraries(weir_cuda_backend PUBLIC weir_cuda weir_gpu)
  endif()
  if(WEIR_BUILD_BENCH AND NOT WEIR_EMBED)
    # As few shared libraries as it uses: it runs on machines that have a device and little else.
    foreach(name load frames decode paging)
      add_executable(weir_bench_${name} ${PROJECT_SOURCE_DIR}/bench/gpu/bench_${name}.cpp)
      target_link_options(weir_bench_${name} PRIVATE -Wl,--as-needed)
      target_link_libraries(weir_bench_${name} PRIVATE weir_cuda_backend weir_format)
      set_target_properties(weir_bench_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bench)
    endforeach()
  endif()
elseif(WEIR_CUDA STREQUAL "ON")
  message(FATAL_ERROR "WEIR_CUDA=ON, but there is no nvcc: name it with -DCMAKE_CUDA_COMPILER=")
endif()
