# find_package(weir [COMPONENTS NAME...]): weir::format_core and weir::gpu_core; weir::c, the C interface, but where
# weir was built with WEIR_EMBED; weir::mpi where the component mpi is installed, the project compiles C and there is an
# MPI; and weir::cuda where weir was built with CUDA and the project compiles CUDA (enable_language(CUDA) before).
# weir_NAME_FOUND says which there are. find_package fails only where one is missing that it requires.

include(${CMAKE_CURRENT_LIST_DIR}/weirTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/weirCTargets.cmake OPTIONAL)
if(CMAKE_C_COMPILER AND EXISTS ${CMAKE_CURRENT_LIST_DIR}/weirMpiTargets.cmake)
  find_package(MPI QUIET COMPONENTS C)
  if(MPI_C_FOUND)
    include(${CMAKE_CURRENT_LIST_DIR}/weirMpiTargets.cmake)
  endif()
endif()
if(CMAKE_CUDA_COMPILER AND EXISTS ${CMAKE_CURRENT_LIST_DIR}/weirCudaTargets.cmake)
  include(CMakeFindDependencyMacro)
  find_dependency(Threads)
  find_dependency(CUDAToolkit)
  include(${CMAKE_CURRENT_LIST_DIR}/weirCudaTargets.cmake)
endif()

set(weir_components "")
foreach(weir_component format_core gpu_core c mpi cuda)
  set(weir_${weir_component}_FOUND FALSE)
  if(TARGET weir::${weir_component})
    set(weir_${weir_component}_FOUND TRUE)
    string(APPEND weir_components " ${weir_component}")
  endif()
endforeach()
foreach(weir_component ${weir_FIND_COMPONENTS})
  if(weir_FIND_REQUIRED_${weir_component} AND NOT weir_${weir_component}_FOUND)
    set(weir_FOUND FALSE)
    set(weir_NOT_FOUND_MESSAGE "it has no component ${weir_component} here, but:${weir_components}. mpi has to be \
installed besides, and needs a project of the language C and an MPI; cuda needs one of the language CUDA")
  endif()
endforeach()
