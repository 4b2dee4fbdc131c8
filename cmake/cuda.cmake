# The tracer's templates compiled for the device (gpu/*.cu), where nvcc is found.
# At file scope: enable_language does not work inside a function.

include(CheckLanguage)
find_program(WEIR_NVCC nvcc PATHS /usr/local/cuda/bin)
if(WEIR_NVCC AND NOT CMAKE_CUDA_COMPILER)
  set(CMAKE_CUDA_COMPILER ${WEIR_NVCC})
endif()
check_language(CUDA)
if(CMAKE_CUDA_COMPILER)
  set(CMAKE_CUDA_ARCHITECTURES 90 CACHE STRING "Compute capabilities to compile for")
  enable_language(CUDA)
  if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)  # CMake 3.25 does not know that nvcc 12 and later have it
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
    set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
    set(CMAKE_CUDA20_STANDARD__HAS_FULL_SUPPORT ON)
  endif()
  file(GLOB WEIR_CUDA_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/gpu/*.cu)
  add_library(weir_cuda_check OBJECT ${WEIR_CUDA_SOURCES})
  target_include_directories(weir_cuda_check PRIVATE ${PROJECT_SOURCE_DIR})
elseif(WEIR_CUDA STREQUAL "ON")
  message(FATAL_ERROR "WEIR_CUDA=ON, but there is no nvcc: name it with -DCMAKE_CUDA_COMPILER=")
endif()
