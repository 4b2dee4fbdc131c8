# Drivers: what needs a large library of others, to read a format or to draw, as shared objects loaded at their first use
# (ingest/drivers/driver.h). In the build folder's drivers/; installed in the folder weir of the libraries.

include(GNUInstallDirs)

# Programs and drivers know each other by a digest of what both are compiled with.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/format/*.h ${PROJECT_SOURCE_DIR}/ingest/*.h
                                            ${PROJECT_SOURCE_DIR}/tools/plot/*.h)
set(digests ${PROJECT_VERSION} ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_FLAGS})
foreach(header IN LISTS headers)
  file(SHA256 ${header} digest)
  string(APPEND digests ${digest})
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${headers})
string(SHA256 WEIR_DRIVER_DIGEST "${digests}")
string(SUBSTRING ${WEIR_DRIVER_DIGEST} 0 16 WEIR_DRIVER_DIGEST)
set_property(SOURCE ingest/drivers/driver.cpp APPEND PROPERTY COMPILE_DEFINITIONS
             WEIR_DRIVER_SYMBOL=weir_driver_${WEIR_DRIVER_DIGEST})

# weir_driver(NAME source... LINKS library...): weir_NAME.so.
function(weir_driver name)
  cmake_parse_arguments(ARG "" "" "LINKS" ${ARGN})
  add_library(weir_${name} MODULE ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(weir_${name} PRIVATE weir_ingest ${ARG_LINKS})
  target_compile_definitions(weir_${name} PRIVATE WEIR_DRIVER_SYMBOL=weir_driver_${WEIR_DRIVER_DIGEST})
  # Nothing but the entry is to be seen, so that the driver uses its own code and the program its own.
  target_link_options(weir_${name} PRIVATE LINKER:--exclude-libs,ALL)
  set_target_properties(weir_${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                                                LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/drivers)
  set_property(GLOBAL APPEND PROPERTY WEIR_DRIVERS weir_${name})
endfunction()

# Those of an earlier configuration must not be found.
foreach(name HDF5 OPENVDB PLOT)
  if(NOT WEIR_${name})
    string(TOLOWER ${name} file)
    file(REMOVE ${CMAKE_BINARY_DIR}/drivers/weir_${file}.so)
  endif()
endforeach()

if(WEIR_HDF5)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/ingest/hdf5/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/hdf5_entry\\.cpp$")
  add_library(weir_ingest_hdf5 STATIC ${sources})
  target_link_libraries(weir_ingest_hdf5 PUBLIC weir_ingest ${HDF5_C_LIBRARIES})
  target_include_directories(weir_ingest_hdf5 SYSTEM PUBLIC ${HDF5_C_INCLUDE_DIRS})
  weir_driver(hdf5 ingest/hdf5/hdf5_entry.cpp LINKS weir_ingest_hdf5)
endif()
if(WEIR_OPENVDB)
  weir_driver(openvdb ingest/vdb/openvdb_entry.cpp LINKS ${OPENVDB_LIBRARY} ${IMATH_LIBRARY} TBB::tbb)
  target_include_directories(weir_openvdb SYSTEM PRIVATE ${OPENVDB_INCLUDE_DIR} ${IMATH_INCLUDE_DIR})
endif()
if(WEIR_PLOT)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(CAIRO REQUIRED cairo cairo-svg cairo-png)
  weir_driver(plot tools/plot/plot_entry.cpp LINKS ${CAIRO_LINK_LIBRARIES})
  target_include_directories(weir_plot SYSTEM PRIVATE ${CAIRO_INCLUDE_DIRS})
endif()
get_property(WEIR_DRIVERS GLOBAL PROPERTY WEIR_DRIVERS)

# weir_use_drivers(TARGET [FOLDER...]): the program or library may load them. They are built before it, and it finds them
# in the build and, where it is installed in one of the folders, there.
function(weir_use_drivers target)
  if(NOT WEIR_DRIVERS)
    return()
  endif()
  add_dependencies(${target} ${WEIR_DRIVERS})
  set_property(TARGET ${target} APPEND PROPERTY BUILD_RPATH ${CMAKE_BINARY_DIR}/drivers)
  foreach(folder IN LISTS ARGN)
    file(RELATIVE_PATH path /prefix/${folder} /prefix/${CMAKE_INSTALL_LIBDIR}/weir)
    set_property(TARGET ${target} APPEND PROPERTY INSTALL_RPATH $ORIGIN/${path})
  endforeach()
endfunction()

# weir_install_drivers()
function(weir_install_drivers)
  if(WEIR_DRIVERS)
    install(TARGETS ${WEIR_DRIVERS} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/weir)
  endif()
endfunction()
