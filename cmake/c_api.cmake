# The C interface: libweir.so, target weir_c, also called weir::c, with bindings/c/weir.h; and its tests.

file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bindings/c/*.cpp)
add_library(weir_c SHARED ${sources})
add_library(weir::c ALIAS weir_c)
target_link_libraries(weir_c PRIVATE weir_compressor weir_gpu_core)
set(WEIR_C_HEADERS ${PROJECT_SOURCE_DIR}/bindings/c/weir.h)
target_include_directories(weir_c PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/bindings/c>
                                         $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_definitions(weir_c PRIVATE WEIR_VERSION="${PROJECT_VERSION}")
set_source_files_properties(bindings/c/conversion_options.cpp PROPERTIES COMPILE_DEFINITIONS WEIR_COMMIT="${WEIR_COMMIT}")
# The second number of the version may change what is there while the first is 0.
set_target_properties(weir_c PROPERTIES OUTPUT_NAME weir EXPORT_NAME c VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
                      CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                      LINK_DEPENDS ${PROJECT_SOURCE_DIR}/bindings/c/weir.map)
target_link_options(weir_c PRIVATE LINKER:--version-script=${PROJECT_SOURCE_DIR}/bindings/c/weir.map
                                   LINKER:--as-needed)

# weir_c_tests(): every tests/bindings/c/NAME_test.c as a program of its own, strict C99, that ctest knows as c/NAME_test.
function(weir_c_tests)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/bindings/c/*_test.c)
  add_custom_target(weir_tests_c)
  foreach(source IN LISTS sources)
    get_filename_component(name ${source} NAME_WE)
    set(target weir_c_${name})
    add_executable(${target} ${source})
    target_link_libraries(${target} PRIVATE weir_c Threads::Threads m)
    target_compile_options(${target} PRIVATE -pedantic -Wall -Wextra -Wconversion -Wshadow -Werror)
    set_target_properties(${target} PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF
                                               RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests_c)
    add_test(NAME c/${name} COMMAND ${target})
    add_dependencies(weir_tests_c ${target})
  endforeach()
endfunction()
