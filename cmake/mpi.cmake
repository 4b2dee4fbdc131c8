# What runs in several processes of an MPI job: weir-mpi.

# Sanitizers find in MPI's own libraries what nobody here can mend; the fuzzers need none.
if(WEIR_MPI STREQUAL "AUTO" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  return()
endif()
find_package(MPI COMPONENTS C QUIET)
if(NOT MPI_C_FOUND)
  if(WEIR_MPI STREQUAL "ON")
    message(FATAL_ERROR "WEIR_MPI=ON needs an MPI, for instance libopenmpi-dev and openmpi-bin")
  endif()
  return()
endif()

add_library(weir_mpi_team STATIC bindings/mpi/agreement.cpp bindings/mpi/mpi_team.cpp bindings/mpi/mpi_file_system.cpp)
target_link_libraries(weir_mpi_team PUBLIC weir_compressor MPI::MPI_C)
target_compile_definitions(weir_mpi_team PUBLIC OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)

add_executable(weir-mpi bindings/mpi/weir_mpi.cpp)
target_link_libraries(weir-mpi PRIVATE weir_mpi_team weir_tools)
weir_use_drivers(weir-mpi ${CMAKE_INSTALL_BINDIR})
target_compile_definitions(weir-mpi PRIVATE WEIR_VERSION="${PROJECT_VERSION}")

# libweir_mpi.so, target weir_mpi, also called weir::mpi: pushes by all processes, with bindings/mpi/weir_mpi.h.
add_library(weir_mpi SHARED bindings/mpi/push.cpp bindings/mpi/pushed_boxes.cpp bindings/c/conversion_options.cpp
                            bindings/c/short_text.cpp bindings/c/status.cpp bindings/c/wording.cpp)
add_library(weir::mpi ALIAS weir_mpi)
target_link_libraries(weir_mpi PRIVATE weir_mpi_team PUBLIC weir_c MPI::MPI_C)
target_include_directories(weir_mpi PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/bindings/mpi>)
target_compile_definitions(weir_mpi PRIVATE WEIR_VERSION="${PROJECT_VERSION}")
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/weir_mpi.map @ONLY
     CONTENT "# Nothing of the libraries in it.\nWEIR_MPI_@WEIR_ABI@ {\n  global: weir_mpi_*;\n  local: *;\n};\n")
set_target_properties(weir_mpi PROPERTIES EXPORT_NAME mpi VERSION ${PROJECT_VERSION} SOVERSION ${WEIR_ABI}
                      CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                      LINK_DEPENDS ${CMAKE_BINARY_DIR}/weir_mpi.map)
target_link_options(weir_mpi PRIVATE LINKER:--version-script=${CMAKE_BINARY_DIR}/weir_mpi.map LINKER:--as-needed
                    LINKER:-z,nodelete)  # as weir_c

# weir_install_mpi(): the command, the library and its header, as the component `mpi` of their own, since they need the MPI
# that they were built with: cmake --install BUILD --component mpi, to where the rest is installed.
function(weir_install_mpi)
  set(component COMPONENT mpi EXCLUDE_FROM_ALL)
  install(TARGETS weir-mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} ${component})
  install(TARGETS weir_mpi EXPORT weirMpiTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${component}
          NAMELINK_COMPONENT mpi)
  install(EXPORT weirMpiTargets NAMESPACE weir:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/weir ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/bindings/mpi/weir_mpi.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${component})
endfunction()

# weir_mpi_tests(): tests/bindings/mpi, which start jobs of several processes on this machine.
function(weir_mpi_tests)
  if(TARGET weir_tests_tools AND TARGET weir_share AND MPI_C_COMPILER)  # it installs them
    add_dependencies(weir_tests_tools weir-mpi weir_mpi)
    set_property(SOURCE ${PROJECT_SOURCE_DIR}/tests/tools/install/mpi_install_test.cpp PROPERTY COMPILE_DEFINITIONS
                 WEIR_CMAKE="${CMAKE_COMMAND}" WEIR_MPICC="${MPI_C_COMPILER}" WEIR_MPI_INSTALLS="${CMAKE_BINARY_DIR}")
  endif()
  if(NOT MPIEXEC_EXECUTABLE)
    return()
  endif()
  add_executable(weir_mpi_push_boxes tests/bindings/mpi/push_boxes.c)
  add_executable(weir_mpi_heat examples/mpi/heat.c)
  foreach(target weir_mpi_push_boxes weir_mpi_heat)
    target_link_libraries(${target} PRIVATE weir_mpi)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/bindings/c)
    target_compile_options(${target} PRIVATE -pedantic -Wall -Wextra -Wconversion -Wshadow)
    set_target_properties(${target} PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
  endforeach()
  cmake_path(GET MPI_C_COMPILER PARENT_PATH wrappers)  # the Fortran compiler's wrapper of the same MPI, where there is one
  add_executable(weir_tests_mpi tests/bindings/mpi/agreement_test.cpp tests/bindings/mpi/hangup_test.cpp tests/bindings/mpi/mpi_test.cpp)
  add_dependencies(weir_tests weir_tests_mpi)
  add_dependencies(weir_tests_mpi weir weir-mpi weir_mpi_push_boxes weir_mpi_heat)
  target_link_libraries(weir_tests_mpi PRIVATE weir_test_support GTest::gtest_main)
  target_compile_definitions(weir_tests_mpi PRIVATE WEIR_SOURCE_DIR="${PROJECT_SOURCE_DIR}" WEIR_COMMAND="$<TARGET_FILE:weir>"
                             WEIR_MPIEXEC="${MPIEXEC_EXECUTABLE}" WEIR_MPI_COMMAND="$<TARGET_FILE:weir-mpi>"
                             WEIR_MPI_PUSH="$<TARGET_FILE:weir_mpi_push_boxes>" WEIR_MPI_EXAMPLE="$<TARGET_FILE:weir_mpi_heat>"
                             WEIR_MPI_FORTRAN="${wrappers}/mpifort" WEIR_MPI_LIBRARY="$<TARGET_FILE:weir_mpi>"
                             WEIR_C_LIBRARY="$<TARGET_FILE:weir_c>")
  gtest_discover_tests(weir_tests_mpi DISCOVERY_TIMEOUT 120 NO_PRETTY_VALUES TEST_FILTER *-${WEIR_TESTS_LEFT_OUT}
                       PROPERTIES PROCESSORS 2)
endfunction()
