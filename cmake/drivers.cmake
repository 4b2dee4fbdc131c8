# Drivers: what needs a large library of others, to read a format or to draw, as shared objects loaded at their first use
# (ingest/drivers/driver.h). In the build folder's drivers/; installed in the folder weir of the libraries.

include(GNUInstallDirs)
string(REPLACE "." "_" WEIR_DRIVER_VERSION ${PROJECT_VERSION})
target_compile_definitions(weir_ingest PUBLIC WEIR_DRIVER_SYMBOL=weir_driver_${WEIR_DRIVER_VERSION}
                           PRIVATE WEIR_LIBRARY_FOLDER="${CMAKE_INSTALL_LIBDIR}"
                                   WEIR_ARCHITECTURE="${CMAKE_LIBRARY_ARCHITECTURE}")

# weir_driver(NAME source... LINKS library...): weir_NAME.so.
function(weir_driver name)
  cmake_parse_arguments(ARG "" "" "LINKS" ${ARGN})
  add_library(weir_${name} MODULE ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(weir_${name} PRIVATE weir_ingest ${ARG_LINKS})
  # Nothing but the entry is to be seen, so that the driver uses its own code and the program its own.
  target_link_options(weir_${name} PRIVATE LINKER:--exclude-libs,ALL)
  set_target_properties(weir_${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                                                LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/drivers)
  set_property(GLOBAL APPEND PROPERTY WEIR_DRIVERS weir_${name})
endfunction()

if(WEIR_HDF5)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/ingest/hdf5/*.cpp)
  list(FILTER sources EXCLUDE REGEX "hdf5_entry")
  add_library(weir_ingest_hdf5 STATIC ${sources})
  target_link_libraries(weir_ingest_hdf5 PUBLIC weir_ingest ${HDF5_C_LIBRARIES})
  target_include_directories(weir_ingest_hdf5 SYSTEM PUBLIC ${HDF5_C_INCLUDE_DIRS})
  weir_driver(hdf5 ingest/hdf5/hdf5_entry.cpp LINKS weir_ingest_hdf5)
endif()
if(WEIR_OPENVDB)
  weir_driver(openvdb ingest/vdb/openvdb_entry.cpp LINKS ${OPENVDB_LIBRARY} ${IMATH_LIBRARY} TBB::tbb)
endif()
if(WEIR_PLOT)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(CAIRO REQUIRED cairo cairo-svg cairo-png)
  weir_driver(plot tools/plot/plot_entry.cpp LINKS ${CAIRO_LIBRARIES})
  target_include_directories(weir_plot SYSTEM PRIVATE ${CAIRO_INCLUDE_DIRS})
endif()
get_property(WEIR_DRIVERS GLOBAL PROPERTY WEIR_DRIVERS)

# weir_use_drivers(TARGET): those that the program may load are built before it.
function(weir_use_drivers target)
  if(WEIR_DRIVERS)
    add_dependencies(${target} ${WEIR_DRIVERS})
  endif()
endfunction()

# weir_install_drivers()
function(weir_install_drivers)
  if(WEIR_DRIVERS)
    install(TARGETS ${WEIR_DRIVERS} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/weir)
  endif()
endfunction()
