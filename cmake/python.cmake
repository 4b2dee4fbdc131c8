# The Python module `weir` of bindings/python, for Debian's own interpreter (one of pyenv or conda, first in PATH, would
# not see Debian's numpy, nor be what imports an installed module). The build folder's python/ is for PYTHONPATH.

# An interpreter without the sanitizer cannot load a module with it, and the fuzzers need none.
if(WEIR_PYTHON STREQUAL "AUTO" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  return()
endif()
set(WEIR_PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The interpreter that the Python module is built for")
set(Python3_EXECUTABLE ${WEIR_PYTHON_EXECUTABLE})
find_package(Python3 3.10 COMPONENTS Interpreter Development.Module NumPy)
find_package(pybind11 2.9)
if(NOT Python3_FOUND OR NOT pybind11_FOUND)
  if(WEIR_PYTHON STREQUAL "ON")
    message(FATAL_ERROR "WEIR_PYTHON=ON needs pybind11-dev, python3-dev and python3-numpy")
  endif()
  return()
endif()

file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bindings/python/*.cpp)
pybind11_add_module(weir_python MODULE NO_EXTRAS ${sources})
target_link_libraries(weir_python PRIVATE weir_tools $<TARGET_NAME_IF_EXISTS:weir_cuda_source>)
weir_use_drivers(weir_python lib/python3/dist-packages/weir)
target_compile_definitions(weir_python PRIVATE WEIR_VERSION="${PROJECT_VERSION}")
# Other modules of a process have libraries of their own: nothing but the module's entry is to be seen.
target_link_options(weir_python PRIVATE LINKER:--exclude-libs,ALL LINKER:--as-needed)

set(package ${CMAKE_BINARY_DIR}/python/weir)
set_target_properties(weir_python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${package})
file(GLOB modules CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bindings/python/weir/*.py
                                    ${PROJECT_SOURCE_DIR}/bindings/python/weir/*.pyi)
list(APPEND modules ${PROJECT_SOURCE_DIR}/bindings/python/weir/py.typed)
foreach(module IN LISTS modules)
  file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR}/bindings/python/weir ${module})
  configure_file(${module} ${package}/${name} COPYONLY)
endforeach()

# What importlib.metadata reads, and xarray finds its engine "weir" by.
set(WEIR_PYTHON_METADATA weir-${PROJECT_VERSION}.dist-info)
set(metadata ${CMAKE_BINARY_DIR}/python/${WEIR_PYTHON_METADATA})
configure_file(${PROJECT_SOURCE_DIR}/bindings/python/metadata/METADATA.in ${metadata}/METADATA @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/bindings/python/metadata/entry_points.txt ${metadata}/entry_points.txt COPYONLY)

# weir_install_python(): the module. Debian's interpreter looks below /usr/local in a folder of its own version, which
# cmake --install fills, and below /usr in one of all 3.x, which is the package's.
set(WEIR_PYTHON_MODULES ${modules})
function(weir_install_python)
  set(local lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/dist-packages)
  set(debian lib/python3/dist-packages)
  set(metadata ${CMAKE_BINARY_DIR}/python/${WEIR_PYTHON_METADATA})
  install(TARGETS weir_python LIBRARY DESTINATION ${local}/weir COMPONENT python)
  install(FILES ${WEIR_PYTHON_MODULES} DESTINATION ${local}/weir COMPONENT python)
  install(DIRECTORY ${metadata} DESTINATION ${local} COMPONENT python)
  install(TARGETS weir_python LIBRARY DESTINATION ${debian}/weir COMPONENT debian EXCLUDE_FROM_ALL)
  install(FILES ${WEIR_PYTHON_MODULES} DESTINATION ${debian}/weir COMPONENT debian EXCLUDE_FROM_ALL)
  install(DIRECTORY ${metadata} DESTINATION ${debian} COMPONENT debian EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_SOURCE_DIR}/bindings/paraview/weir_reader.py DESTINATION ${CMAKE_INSTALL_DATADIR}/weir/paraview)
endfunction()

# weir_python_tests(): each tests/bindings/python/test_NAME.py, and that of the independent decoder in tests/packed, as the
# test python.NAME.
function(weir_python_tests)
  add_dependencies(weir_tests weir_python)
  file(GLOB tests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/bindings/python/test_*.py
       ${PROJECT_SOURCE_DIR}/tests/packed/test_*.py)
  foreach(test IN LISTS tests)
    get_filename_component(name ${test} NAME_WE)
    string(REGEX REPLACE "^test_" "python." name ${name})
    if(name IN_LIST WEIR_SLOW_TEST_NAMES)
      continue()
    endif()
    add_test(NAME ${name} COMMAND ${WEIR_PYTHON_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/tests/bindings/python/run.py ${test})
    set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77
      ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python;WEIR_COMMAND=$<TARGET_FILE:weir>;WEIR_SOURCE=${PROJECT_SOURCE_DIR}")
  endforeach()
endfunction()
