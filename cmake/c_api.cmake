# The C interface: libweir.so, target weir_c, also called weir::c, with bindings/c/weir.h and, where it is built with
# CUDA, bindings/c/weir_cuda.h; and its tests.

file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bindings/c/*.cpp)
if(NOT TARGET weir_cuda)
  list(FILTER sources EXCLUDE REGEX "/cuda_[a-z]+\\.cpp$")
endif()
add_library(weir_c SHARED ${sources})
add_library(weir::c ALIAS weir_c)
target_link_libraries(weir_c PRIVATE weir_compressor weir_gpu_core $<TARGET_NAME_IF_EXISTS:weir_cuda_expand>
                             $<TARGET_NAME_IF_EXISTS:weir_cuda_push> $<TARGET_NAME_IF_EXISTS:weir_cuda_encode>)
weir_use_drivers(weir_c ${CMAKE_INSTALL_LIBDIR})
target_include_directories(weir_c PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/bindings/c>
                                         $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_definitions(weir_c PRIVATE WEIR_VERSION="${PROJECT_VERSION}")
# What is there may change with the second number of the version while the first is 0.
set(WEIR_ABI ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/weir.map @ONLY
     CONTENT "# Nothing of the libraries in it.\nWEIR_@WEIR_ABI@ {\n  global: weir_*;\n  local: *;\n};\n")
set_target_properties(weir_c PROPERTIES OUTPUT_NAME weir EXPORT_NAME c VERSION ${PROJECT_VERSION}
                      SOVERSION ${WEIR_ABI}
                      CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON LINK_DEPENDS ${CMAKE_BINARY_DIR}/weir.map)
target_link_options(weir_c PRIVATE LINKER:--version-script=${CMAKE_BINARY_DIR}/weir.map LINKER:--as-needed
                    LINKER:-z,nodelete)  # oneTBB's threads run on after a conversion, with code that dlclose would unmap

# weir_install_c(): the library and its header, for find_package(weir), pkg-config, or -lweir.
function(weir_install_c)
  install(TARGETS weir_c EXPORT weirCTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT weirCTargets NAMESPACE weir:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/weir)
  set(headers ${PROJECT_SOURCE_DIR}/bindings/c/weir.h)
  if(TARGET weir_cuda)
    list(APPEND headers ${PROJECT_SOURCE_DIR}/bindings/c/weir_cuda.h)
  endif()
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  file(RELATIVE_PATH WEIR_PC_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)  # wherever that will be
  configure_file(${PROJECT_SOURCE_DIR}/bindings/c/weir.pc.in ${CMAKE_BINARY_DIR}/weir.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/weir.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

# weir_c_tests(): every tests/bindings/c/NAME_test.c as a program of its own, strict C99, that ctest knows as c/NAME_test,
# and every NAME_test.cpp there, of what the library does not show, in weir_c_parts_test. All of them are the target weir_tests_c.
function(weir_c_tests)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/bindings/c/*_test.c)
  if(NOT TARGET weir_cuda)
    list(FILTER sources EXCLUDE REGEX "/cuda_test\\.c$")
  endif()
  add_custom_target(weir_tests_c)
  add_dependencies(weir_tests weir_tests_c)
  foreach(source IN LISTS sources)
    get_filename_component(name ${source} NAME_WE)
    set(target weir_c_${name})
    add_executable(${target} ${source})
    target_link_libraries(${target} PRIVATE weir_c Threads::Threads m)
    target_compile_options(${target} PRIVATE -pedantic -Wall -Wextra -Wconversion -Wshadow -Werror)
    set_target_properties(${target} PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF
                                               RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests_c)
    if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
      set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX)  # for the part of the sanitizer that C++ calls
    endif()
    add_test(NAME c/${name} COMMAND ${target})
    add_dependencies(weir_tests_c ${target})
  endforeach()
  file(GLOB parts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/bindings/c/*_test.cpp)
  add_executable(weir_c_parts_test ${parts} ${PROJECT_SOURCE_DIR}/bindings/c/conversion_options.cpp
                                   ${PROJECT_SOURCE_DIR}/bindings/c/short_text.cpp
                                   ${PROJECT_SOURCE_DIR}/bindings/c/status.cpp
                                   ${PROJECT_SOURCE_DIR}/bindings/c/wording.cpp)
  target_compile_definitions(weir_c_parts_test PRIVATE WEIR_VERSION="${PROJECT_VERSION}"
                                                       WEIR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(weir_c_parts_test PRIVATE weir_compressor GTest::gtest GTest::gtest_main)
  gtest_discover_tests(weir_c_parts_test)
  add_dependencies(weir_tests_c weir_c_parts_test)
  if(TARGET weir_cuda)
    target_link_libraries(weir_c_cuda_test PRIVATE CUDA::cudart_static)
    # The example of docs/embedding.md; ctest runs it where there is a device.
    add_executable(weir_push_cuda ${PROJECT_SOURCE_DIR}/examples/push_cuda/gray_scott.cu)
    target_link_libraries(weir_push_cuda PRIVATE weir_c Threads::Threads)
    set_target_properties(weir_push_cuda PROPERTIES OUTPUT_NAME gray_scott_cuda
                                                    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests_c)
    add_test(NAME examples/push_cuda COMMAND weir_push_cuda 100 40 20 ${CMAKE_BINARY_DIR}/tests_c)
    set_tests_properties(examples/push_cuda PROPERTIES SKIP_REGULAR_EXPRESSION "no CUDA-capable device|driver")
    add_dependencies(weir_tests_c weir_push_cuda)
  endif()
  if(TARGET weir_tests_tools)  # those of the installed library
    target_link_libraries(weir_tests_tools PRIVATE weir_c)
    target_sources(weir_tests_tools PRIVATE ${PROJECT_SOURCE_DIR}/bindings/c/wording.cpp)
    set_property(SOURCE ${PROJECT_SOURCE_DIR}/tests/tools/install/c_api_test.cpp ${PROJECT_SOURCE_DIR}/tests/tools/install/install_test.cpp
                 APPEND PROPERTY COMPILE_DEFINITIONS WEIR_ABI="${WEIR_ABI}")
    set(installs)
    if(TARGET weir_share)
      set(installs WEIR_INSTALLS="${CMAKE_BINARY_DIR}")
    endif()
    set_property(SOURCE ${PROJECT_SOURCE_DIR}/tests/tools/install/c_api_test.cpp APPEND PROPERTY COMPILE_DEFINITIONS
                 WEIR_CC="${CMAKE_C_COMPILER}" WEIR_CXX="${CMAKE_CXX_COMPILER}" WEIR_CMAKE="${CMAKE_COMMAND}"
                 WEIR_GENERATOR="${CMAKE_GENERATOR}" WEIR_NVCC="${CMAKE_CUDA_COMPILER}"
                 WEIR_C_LIBRARY="$<TARGET_FILE:weir_c>" ${installs})
    set_property(SOURCE ${PROJECT_SOURCE_DIR}/tests/tools/install/fortran_test.cpp APPEND PROPERTY COMPILE_DEFINITIONS
                 WEIR_C_LIBRARY="$<TARGET_FILE:weir_c>" ${installs})
  endif()
endfunction()
