# Options every target of weir is compiled with, and the two shapes of target
# there are: a folder as a library, a tests/ folder as one test program.

add_library(weir_options INTERFACE)
target_include_directories(weir_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
set_target_properties(weir_options PROPERTIES EXPORT_NAME options)
target_compile_features(weir_options INTERFACE cxx_std_20)
# A decoded value is two roundings everywhere: never let the compiler fuse them.
target_compile_options(weir_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
                                              $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-ffp-contract=off>)
if(NOT WEIR_EMBED)  # another program chooses its own warnings
  target_compile_options(weir_options INTERFACE
                         $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Wall$<SEMICOLON>-Wextra$<SEMICOLON>-Wconversion$<SEMICOLON>-Wshadow>>)
endif()
# A compiler newer than those weir is checked with brings warnings of its own: shown, but no failure.
if(WEIR_WERROR AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
  set(WEIR_WERROR OFF)
elseif(WEIR_WERROR AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 15)
  set(WEIR_WERROR OFF)
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC lets a class use an unnamed namespace in the file that it compiles, not in one that this file includes.
  target_compile_options(weir_options INTERFACE $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>>)
elseif(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # Clang takes a local name for a shadow of a function in another file of the group; GCC sees the shadows that matter.
  target_compile_options(weir_options INTERFACE $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Wno-shadow>>)
endif()
if(WEIR_WERROR)
  target_compile_options(weir_options INTERFACE $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-Werror>>)
endif()

if(WEIR_TIDY)
  find_program(WEIR_CLANG_TIDY NAMES clang-tidy-14 clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${WEIR_CLANG_TIDY} --quiet --warnings-as-errors=*)
  # A changed configuration changes the command line, so that every file is looked at again.
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS .clang-tidy)
  file(SHA256 ${PROJECT_SOURCE_DIR}/.clang-tidy tidy_digest)
  target_compile_definitions(weir_options INTERFACE $<BUILD_INTERFACE:WEIR_TIDY_CONFIGURATION="${tidy_digest}">)
endif()

# weir_core(NAME FILES name... HEADERS name... LINKS target...): those files of NAME/, which need no library, and headers
# without a source, as weir_NAME_core, also called weir::NAME_core: what another program embeds (docs/embedding.md).
function(weir_core name)
  cmake_parse_arguments(ARG "" "" "FILES;HEADERS;LINKS" ${ARGN})
  set(folder ${PROJECT_SOURCE_DIR}/${name})
  set(sources ${ARG_FILES})
  list(TRANSFORM sources REPLACE ".+" "${folder}/\\0.cpp")
  set(headers ${ARG_FILES} ${ARG_HEADERS})
  list(TRANSFORM headers REPLACE ".+" "${folder}/\\0.h")
  add_library(weir_${name}_core STATIC ${sources})
  add_library(weir::${name}_core ALIAS weir_${name}_core)
  set_target_properties(weir_${name}_core PROPERTIES EXPORT_NAME ${name}_core)
  target_sources(weir_${name}_core PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${headers})
  target_link_libraries(weir_${name}_core PUBLIC weir_options ${ARG_LINKS})
endfunction()

# weir_library(NAME [WITHOUT regex] LINKS target...): every .cpp in NAME/ and below but main.cpp, what needs the CUDA
# toolkit, what the expression matches of NAME/..., and what weir_NAME_core has, which is linked where there is one.
function(weir_library name)
  cmake_parse_arguments(ARG "" "WITHOUT" "LINKS" ${ARGN})
  # Names below the sources: an expression must not match the folders that they lie in.
  file(GLOB_RECURSE sources RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${name}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$|^gpu/cuda/")
  if(ARG_WITHOUT)
    list(FILTER sources EXCLUDE REGEX "${ARG_WITHOUT}")
  endif()
  list(TRANSFORM sources PREPEND ${PROJECT_SOURCE_DIR}/)
  if(TARGET weir_${name}_core)
    get_target_property(core weir_${name}_core SOURCES)
    list(REMOVE_ITEM sources ${core})
    list(PREPEND ARG_LINKS weir_${name}_core)
  endif()
  if(NOT sources)
    add_library(weir_${name} INTERFACE)
    target_link_libraries(weir_${name} INTERFACE weir_options ${ARG_LINKS})
    return()
  endif()
  add_library(weir_${name} STATIC ${sources})
  target_link_libraries(weir_${name} PUBLIC weir_options ${ARG_LINKS})
  if(name MATCHES "^(tools|daemon)$" AND WEIR_COMMAND_OPTIMISATION)
    target_compile_options(weir_${name} PRIVATE ${WEIR_COMMAND_OPTIMISATION})
  endif()
endfunction()

# weir_embed_page(TARGET FOLDER FUNCTION HEADER): the files of FOLDER, compiled into TARGET as FUNCTION(), which HEADER
# declares.
function(weir_embed_page target folder function header)
  set(page ${PROJECT_SOURCE_DIR}/${folder})
  set(source ${CMAKE_BINARY_DIR}/${function}.cpp)
  file(GLOB files CONFIGURE_DEPENDS ${page}/*)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_page.cmake)
  add_custom_command(OUTPUT ${source}
                     COMMAND ${CMAKE_COMMAND} -D PAGE=${page} -D FUNCTION=${function} -D HEADER=${header}
                             -D OUTPUT=${source} -P ${script}
                     DEPENDS ${files} ${script} COMMENT "Embedding ${folder}" VERBATIM)
  target_sources(${target} PRIVATE ${source})
endfunction()

# weir_test_libraries(): what test programs share, compiled once: weir_test_support (tests/support/) and weir_test_stock
# (tests/stock/), the only one that includes OpenVDB's and NanoVDB's converters, which take half a minute to compile.
function(weir_test_libraries)
  file(GLOB support CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/support/*.cpp)
  add_library(weir_test_support STATIC ${support})
  target_link_libraries(weir_test_support PUBLIC weir_format GTest::gtest)
  find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h)  # of the test folders that include it
  if(NANOVDB_INCLUDE_DIR)
    target_include_directories(weir_test_support SYSTEM PUBLIC ${NANOVDB_INCLUDE_DIR})
  endif()
  set_property(SOURCE ${PROJECT_SOURCE_DIR}/tests/support/run_command.cpp PROPERTY COMPILE_DEFINITIONS
               WEIR_COMMAND="${CMAKE_BINARY_DIR}/weir")
  target_compile_options(weir_test_support PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:SHELL:${WEIR_TEST_OPTIMISATION}>")
  if(WEIR_OPENVDB)
    file(GLOB stock CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/stock/*.cpp)
    add_library(weir_test_stock STATIC ${stock})
    target_link_libraries(weir_test_stock PUBLIC weir_test_support ${OPENVDB_LIBRARY} ${IMATH_LIBRARY} TBB::tbb)
    target_include_directories(weir_test_stock SYSTEM PUBLIC ${OPENVDB_INCLUDE_DIR} ${IMATH_INCLUDE_DIR})
    target_compile_options(weir_test_stock PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:SHELL:${WEIR_TEST_OPTIMISATION}>")
  endif()
endfunction()

# weir_leave_out(VARIABLE): takes from the test sources in it those that include, themselves or through a header of
# tests/, what this build was left without: HDF5, OpenVDB or the tests' own stock readers, which need OpenVDB, zfp, charts
# or the service. Of a build without HDF5 also those in a folder hdf5/ and those in users/ whose inputs h5py or netCDF4 write.
function(weir_leave_out variable)
  set(missing)
  if(NOT WEIR_HDF5)
    list(APPEND missing hdf5\\.h ingest/hdf5/)
  endif()
  if(NOT WEIR_OPENVDB)
    list(APPEND missing openvdb/ tests/stock/)
  endif()
  if(NOT WEIR_PLOT)
    list(APPEND missing tools/plot/plot_canvas tools/report/histogram_plot tools/sweep/sweep_plot tools/spectrum/spectrum_plot)
  endif()
  if(NOT WEIR_ZFP)
    list(APPEND missing zfp\\.h tools/sweep/zfp_)
  endif()
  if(NOT WEIR_DAEMON)
    list(APPEND missing "daemon/" tools/service/ tools/view/ tools/describe/describe_config)
  endif()
  if(NOT missing)
    return()
  endif()
  file(GLOB_RECURSE headers ${PROJECT_SOURCE_DIR}/tests/*.h)
  foreach(round RANGE 3)
    list(JOIN missing "|" pattern)
    foreach(header IN LISTS headers)
      set(found)
      string(REGEX REPLACE "h$" "cpp" source ${header})
      foreach(file ${header} ${source})  # a header is of no use without its source
        if(EXISTS ${file} AND NOT found)
          file(STRINGS ${file} found REGEX "#include [<\"](${pattern})" LIMIT_COUNT 1)
        endif()
      endforeach()
      if(found)
        file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${header})
        string(REPLACE "." "\\." name ${name})
        list(APPEND missing ${name})
      endif()
    endforeach()
    list(REMOVE_DUPLICATES missing)
  endforeach()
  list(JOIN missing "|" pattern)
  set(kept)
  foreach(source IN LISTS ${variable})
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR}/tests ${source})
    file(STRINGS ${source} found REGEX "#include [<\"](${pattern})" LIMIT_COUNT 1)
    if(NOT WEIR_HDF5 AND NOT found AND name MATCHES "^users/")
      file(STRINGS ${source} found REGEX "h5py|netCDF4" LIMIT_COUNT 1)
    endif()
    if(found OR (NOT WEIR_HDF5 AND name MATCHES "/hdf5/"))
      weir_skip_test(${name} "this build was left without what it includes")
    else()
      list(APPEND kept ${source})
    endif()
  endforeach()
  set(${variable} ${kept} PARENT_SCOPE)
endfunction()

# weir_read_patterns(FILE VARIABLE): its lines, but for comments. The build is configured again where they change.
function(weir_read_patterns file variable)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(STRINGS ${file} patterns REGEX "^[^#]")
  set(${variable} ${patterns} PARENT_SCOPE)
endfunction()

# weir_read_left_out(): makes WEIR_TESTS_LEFT_OUT one filter: the patterns of the file that it may name, and the tests of
# tests/slow_tests.txt, unless WEIR_SLOW_TESTS is on.
function(weir_read_left_out)
  set(left_out ${WEIR_TESTS_LEFT_OUT})
  if(left_out MATCHES "^@(.+)")
    weir_read_patterns(${CMAKE_MATCH_1} left_out)
  endif()
  set(slow)
  if(NOT WEIR_SLOW_TESTS)
    weir_read_patterns(${PROJECT_SOURCE_DIR}/tests/slow_tests.txt slow)
  endif()
  set(WEIR_SLOW_TEST_NAMES ${slow} PARENT_SCOPE)
  list(APPEND left_out ${slow})
  list(JOIN left_out ":" patterns)
  set(WEIR_TESTS_LEFT_OUT ${patterns} PARENT_SCOPE)
endfunction()

# weir_leave_out_unnamed(VARIABLE): takes from the test sources in it those of whose tests WEIR_TESTS names none.
function(weir_leave_out_unnamed variable)
  if(WEIR_TESTS STREQUAL "*")
    return()
  endif()
  string(REPLACE ":" ";" names "${WEIR_TESTS}")
  list(TRANSFORM names REPLACE "\\..*" "")  # the suite's
  list(TRANSFORM names REPLACE "[*]" "[A-Za-z0-9_]*")
  list(TRANSFORM names REPLACE "/" "|")  # PREFIX/SUITE, SUITE/NUMBER
  list(JOIN names "|" suites)
  set(kept)
  foreach(source IN LISTS ${variable})
    file(STRINGS ${source} tests REGEX "^(TYPED_)?TEST(_[FP])?\\(" LIMIT_COUNT 1)
    file(STRINGS ${source} named REGEX "^(TYPED_)?TEST(_[FP])?\\((${suites}), *[A-Za-z]" LIMIT_COUNT 1)
    if(named OR NOT tests)
      list(APPEND kept ${source})
    else()
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    endif()
  endforeach()
  set(${variable} ${kept} PARENT_SCOPE)
endfunction()

# weir_tests(NAME): every .cpp in tests/NAME/ as the program weir_tests_NAME.
function(weir_tests name)
  set(patterns ${PROJECT_SOURCE_DIR}/tests/${name}/*.cpp)
  if(CMAKE_CUDA_COMPILER)
    list(APPEND patterns ${PROJECT_SOURCE_DIR}/tests/${name}/*.cu)
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${patterns})
  if(NOT sources)
    return()
  endif()
  weir_leave_out(sources)
  weir_leave_out_unnamed(sources)
  if(NOT sources)
    return()
  endif()
  add_executable(weir_tests_${name} ${sources})
  set(library weir_${name})
  if(name STREQUAL "cuda")  # they try the renderer too
    set(library weir_cuda_backend weir_cuda_encode)
    # tests/cuda/support/refused_allocations.h
    foreach(function cudaMallocAsync cudaMallocAsync_ptsz cudaHostAlloc cudaMalloc3DArray cudaCreateTextureObject
                     cudaCreateSurfaceObject cudaStreamCreateWithFlags cudaEventCreateWithFlags)
      target_link_options(weir_tests_cuda PRIVATE LINKER:--wrap=${function})
    endforeach()
  endif()
  if(name STREQUAL "ingest" AND WEIR_HDF5)
    set(library weir_ingest_hdf5)
  endif()
  weir_use_drivers(weir_tests_${name})
  if(name MATCHES "^(tools|daemon|users)$")  # they run the command
    set(library weir_tools)
    add_dependencies(weir_tests_${name} weir)
    set(installs)
    if(TARGET weir_share)
      add_dependencies(weir_tests_${name} weir_share)
      set(installs WEIR_INSTALLS="${CMAKE_BINARY_DIR}" WEIR_CPACK="${CMAKE_CPACK_COMMAND}")
      if(TARGET weir_python)
        add_dependencies(weir_tests_${name} weir_python)
        list(APPEND installs WEIR_PYTHON_VERSION="${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}"
                             WEIR_PYTHON_CORE="$<TARGET_FILE_NAME:weir_python>")
      endif()
    endif()
    target_compile_definitions(weir_tests_${name} PRIVATE WEIR_COMMAND="$<TARGET_FILE:weir>")
    # Of those that build a program themselves, with the tools weir is built with, or install weir.
    set_property(SOURCE ${PROJECT_SOURCE_DIR}/tests/tools/support/embedded_example.cpp ${PROJECT_SOURCE_DIR}/tests/tools/install/install_test.cpp
                        ${PROJECT_SOURCE_DIR}/tests/tools/install/embedding_test.cpp PROPERTY COMPILE_DEFINITIONS
                 WEIR_CMAKE="${CMAKE_COMMAND}" WEIR_GENERATOR="${CMAKE_GENERATOR}" WEIR_CXX="${CMAKE_CXX_COMPILER}"
                 WEIR_NVCC="${CMAKE_CUDA_COMPILER}" WEIR_LAUNCHER="${CMAKE_CXX_COMPILER_LAUNCHER}"
                 WEIR_VERSION="${PROJECT_VERSION}" ${installs})
    set_property(SOURCE ${PROJECT_SOURCE_DIR}/tests/tools/install/find_package_test.cpp
                        ${PROJECT_SOURCE_DIR}/tests/tools/install/packaging_test.cpp PROPERTY COMPILE_DEFINITIONS
                 WEIR_CMAKE="${CMAKE_COMMAND}" WEIR_CPACK="${CMAKE_CPACK_COMMAND}" WEIR_GENERATOR="${CMAKE_GENERATOR}"
                 WEIR_CXX="${CMAKE_CXX_COMPILER}" WEIR_VERSION="${PROJECT_VERSION}")
  endif()
  target_link_libraries(weir_tests_${name} PRIVATE ${library} weir_test_support $<TARGET_NAME_IF_EXISTS:weir_test_stock>
                                              GTest::gtest_main)
  if(name STREQUAL "tools" AND WEIR_HDF5)
    target_link_libraries(weir_tests_tools PRIVATE weir_ingest_hdf5)
  endif()
  target_compile_definitions(weir_tests_${name} PRIVATE WEIR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_compile_options(weir_tests_${name} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:SHELL:${WEIR_TEST_OPTIMISATION}>")
  weir_add_gtests(weir_tests_${name})
endfunction()

# weir_add_gtests(TARGET): the tests of a GoogleTest program that WEIR_TESTS names. Most run in groups, several in one
# process: starting a process for each takes longer than most tests. Alone run
#   those with Memory or Ceiling in their name, which measure the memory of their process or of a child, which counts
#   what its parent held;
#   all of the daemon, which run services, with files and times of their own; those with SmallQueue in their name, which
#   change the machine's limit of inotify for a moment, not beside those that count on it.
function(weir_add_gtests target)
  add_dependencies(weir_tests ${target})
  set(alone *Memory*:*Ceiling*)
  if(target STREQUAL "weir_tests_daemon")
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 120 NO_PRETTY_VALUES TEST_FILTER ${WEIR_TESTS}-*SmallQueue*:*TwoThousandFiles*:${WEIR_TESTS_LEFT_OUT})
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 120 NO_PRETTY_VALUES TEST_FILTER *SmallQueue*:*TwoThousandFiles*-${WEIR_TESTS_LEFT_OUT} TEST_LIST ${target}_locked
                         PROPERTIES RESOURCE_LOCK inotify)
    return()
  endif()
  foreach(group RANGE 1 ${WEIR_TEST_GROUPS})
    add_test(NAME ${target}/${group} COMMAND ${target} --gtest_filter=${WEIR_TESTS}-${alone}:${WEIR_TESTS_LEFT_OUT})
    math(EXPR index "${group} - 1")
    set_tests_properties(${target}/${group} PROPERTIES ENVIRONMENT
      "GTEST_TOTAL_SHARDS=${WEIR_TEST_GROUPS};GTEST_SHARD_INDEX=${index};GTEST_OUTPUT=xml:${CMAKE_BINARY_DIR}/test_results/${target}-${group}.xml")
  endforeach()
  if(WEIR_TESTS STREQUAL "*")
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 120 NO_PRETTY_VALUES TEST_FILTER ${alone}-${WEIR_TESTS_LEFT_OUT})
  endif()
endfunction()

# weir_skip_test(NAME WHY): a test in place of those that there are not here, so that they are seen to be skipped. What
# two programs would have is shown once.
function(weir_skip_test name why)
  if(TEST ${name})
    return()
  endif()
  add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${why}")
  set_tests_properties(${name} PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped: ")
endfunction()

# weir_loader_tests(): the grid loader, what takes slabs from a device, and their tests with the pretended CUDA runtime of
# tests/fake_cuda/, as the program weir_tests_loader, which needs CUDA's headers and no device.
function(weir_loader_tests)
  set(root ${PROJECT_SOURCE_DIR})
  file(GLOB sources CONFIGURE_DEPENDS ${root}/gpu/cuda/load/*.cpp ${root}/tests/cuda/load/*.cpp
                                      ${root}/tests/fake_cuda/*.cpp)
  list(APPEND sources ${root}/gpu/cuda/runtime/check.cpp ${root}/gpu/cuda/grid_loader.cpp
                      ${root}/gpu/cuda/runtime/driver_context.cpp
                      ${root}/gpu/cuda/push/device_slabs.cpp ${root}/gpu/cuda/push/device_values.cpp
                      ${root}/tests/cuda/grid_loader_test.cpp)
  weir_leave_out(sources)
  add_executable(weir_tests_loader ${sources})
  target_include_directories(weir_tests_loader SYSTEM PRIVATE ${CUDAToolkit_INCLUDE_DIRS})
  target_link_libraries(weir_tests_loader PRIVATE weir_test_support $<TARGET_NAME_IF_EXISTS:weir_test_stock>
                                                  GTest::gtest_main Threads::Threads ${CMAKE_DL_LIBS})
  weir_add_gtests(weir_tests_loader)
endfunction()

# weir_brick_tests(): the brick cache, and the CUDA back end's pictures of packed grids, on the pretended CUDA runtime,
# kernels' steps on the host, as the program weir_tests_bricks, which needs CUDA's headers and no device. Headers in
# tests/fake_bricks/instead/ take the place of those of the device.
function(weir_brick_tests)
  set(root ${PROJECT_SOURCE_DIR})
  file(GLOB sources CONFIGURE_DEPENDS ${root}/tests/fake_bricks/*.cpp ${root}/gpu/cuda/load/*.cpp ${root}/gpu/cuda/render/*.cpp)
  add_executable(weir_tests_bricks ${sources} ${root}/tests/fake_cuda/fake_runtime.cpp ${root}/tests/fake_cuda/fake_calls.cpp
                                   ${root}/gpu/cuda/runtime/check.cpp ${root}/gpu/cuda/runtime/driver_context.cpp
                                   ${root}/gpu/cuda/grid_loader.cpp
                                   ${root}/gpu/cuda/volume/texture.cpp ${root}/gpu/cuda/volume/device_memory.cpp
                                   ${root}/tests/cuda/refused_memory_test.cpp ${root}/tests/cuda/paging_leak_test.cpp)
  set_target_properties(weir_tests_bricks PROPERTIES UNITY_BUILD OFF)  # some name in unnamed namespaces what instead/ has
  target_include_directories(weir_tests_bricks BEFORE PRIVATE ${root}/tests/fake_bricks/instead)
  target_include_directories(weir_tests_bricks SYSTEM PRIVATE ${CUDAToolkit_INCLUDE_DIRS})
  target_link_libraries(weir_tests_bricks PRIVATE weir_gpu weir_test_support GTest::gtest_main Threads::Threads ${CMAKE_DL_LIBS})
  weir_add_gtests(weir_tests_bricks)
endfunction()

# weir_coder_tests(): conversions whose packed blocks a device surveys and encodes, with the pretended CUDA runtime and the
# kernels' steps on the host, as the program weir_tests_coder, which needs CUDA's headers and no device.
function(weir_coder_tests)
  set(root ${PROJECT_SOURCE_DIR})
  file(GLOB sources CONFIGURE_DEPENDS ${root}/tests/fake_coder/*.cpp ${root}/gpu/cuda/encode/*.cpp ${root}/bindings/cuda/*.cpp)
  add_executable(weir_tests_coder ${sources} ${root}/tests/fake_cuda/fake_runtime.cpp ${root}/tests/fake_cuda/fake_calls.cpp
                                  ${root}/tests/fake_cuda/fake_gather.cpp
                                  ${root}/gpu/cuda/runtime/check.cpp ${root}/gpu/cuda/runtime/driver_context.cpp
                                  ${root}/gpu/cuda/load/pinned_memory.cpp
                                  ${root}/gpu/cuda/push/device_slabs.cpp ${root}/gpu/cuda/push/device_values.cpp
                                  ${root}/gpu/cuda/push/resident_planes.cpp
                                  ${root}/tests/compressor/support/memory_volume.cpp
                                  ${root}/tests/compressor/support/crash_file_system.cpp
                                  ${root}/tests/compressor/support/hard_cases.cpp)
  target_compile_definitions(weir_tests_coder PRIVATE WEIR_HAVE_CUDA)
  target_include_directories(weir_tests_coder SYSTEM PRIVATE ${CUDAToolkit_INCLUDE_DIRS})
  target_link_libraries(weir_tests_coder PRIVATE weir_compressor weir_test_support GTest::gtest_main)
  weir_add_gtests(weir_tests_coder)
endfunction()

# weir_benchmarks(): every bench/NAME.cpp as the Google Benchmark program NAME in the build folder's bench/.
function(weir_benchmarks)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bench/*.cpp)
  weir_leave_out(sources)
  foreach(source IN LISTS sources)
    get_filename_component(name ${source} NAME_WE)
    add_executable(${name} ${source})
    add_dependencies(${name} weir)
    weir_use_drivers(${name})
    target_compile_definitions(${name} PRIVATE WEIR_COMMAND="$<TARGET_FILE:weir>")
    target_link_libraries(${name} PRIVATE weir_compressor weir_gpu $<TARGET_NAME_IF_EXISTS:weir_ingest_hdf5>
                          benchmark::benchmark)
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bench)
  endforeach()
endfunction()

# weir_fuzzers(): every tests/fuzz/NAME.cpp as the libFuzzer program NAME in the build folder's fuzz/; all of them
# are the target weir_fuzzers.
function(weir_fuzzers)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "libFuzzer needs clang: use the preset asan, or -DWEIR_BUILD_FUZZ=OFF")
  endif()
  add_custom_target(weir_fuzzers)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/fuzz/*.cpp)
  foreach(source IN LISTS sources)
    get_filename_component(name ${source} NAME_WE)
    add_executable(${name} ${source})
    target_link_libraries(${name} PRIVATE weir_ingest)
    target_link_options(${name} PRIVATE -fsanitize=fuzzer)
    add_dependencies(weir_fuzzers ${name})
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/fuzz)
  endforeach()
endfunction()
