# find_package(weir): weir::format_core and weir::gpu_core; weir::c, the C interface, but where weir was built with
# WEIR_EMBED; weir::mpi where the component mpi is installed; and weir::cuda where weir was built with CUDA and the project compiles CUDA (enable_language(CUDA) before
# find_package).

include(${CMAKE_CURRENT_LIST_DIR}/weirTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/weirCTargets.cmake OPTIONAL)
if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/weirMpiTargets.cmake)
  include(CMakeFindDependencyMacro)
  find_dependency(MPI COMPONENTS C)
  include(${CMAKE_CURRENT_LIST_DIR}/weirMpiTargets.cmake)
endif()
if(CMAKE_CUDA_COMPILER AND EXISTS ${CMAKE_CURRENT_LIST_DIR}/weirCudaTargets.cmake)
  include(CMakeFindDependencyMacro)
  find_dependency(Threads)
  find_dependency(CUDAToolkit)
  include(${CMAKE_CURRENT_LIST_DIR}/weirCudaTargets.cmake)
endif()
