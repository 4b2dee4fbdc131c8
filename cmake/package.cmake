# cpack makes the Debian package, weir_VERSION_ARCHITECTURE.deb, of what cmake --install brings.

set(WEIR_MAINTAINER "weir maintainers <maintainers@weir.example>" CACHE STRING "Name and address in the Debian package")
set(packaging ${PROJECT_SOURCE_DIR}/packaging)

# Debian keeps a copyright file in place of a licence, and a changelog of its own form, here one entry that points to
# CHANGELOG.md, with the date of the version there.
set(documents ${CMAKE_BINARY_DIR}/packaging)
file(STRINGS ${PROJECT_SOURCE_DIR}/CHANGELOG.md heading REGEX "^## \\[${PROJECT_VERSION}\\] - ")
string(REGEX REPLACE ".* - " "" date "${heading}")
execute_process(COMMAND date --utc --rfc-email --date=${date} OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${documents}/changelog
     "weir (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * See CHANGELOG.md.\n\n -- ${WEIR_MAINTAINER}  ${date}\n")
execute_process(COMMAND gzip -9nf ${documents}/changelog COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${documents}/changelog.gz ${packaging}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT debian EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL weir debian)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_NAME weir)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT ${WEIR_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "converter of dense volumes to NanoVDB files of exactly the size asked")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "\
weir stands between a simulation and a renderer: volumes of any size (HDF5,
NetCDF-4, AMReX, Zarr, OpenVDB, NanoVDB, NRRD, MetaImage, NIfTI, VTK, raw) stream
through bounded memory into standard NanoVDB files that meet a byte budget to the
byte, or an error with as few bytes as meet it, each with a certificate of what it
lost.
It renders them, watches directories beside a running simulation, and has the
libraries that a renderer or a simulation embeds, in C++, C and Fortran.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_folders.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "hdf5-filter-plugin, libnanovdb-tools, python3-numpy, python3-urllib3, python3-xarray")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${packaging}/triggers)
if(WEIR_DAEMON)  # they are about the service
  list(APPEND CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${packaging}/postinst ${packaging}/prerm ${packaging}/postrm ${packaging}/conffiles)
endif()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
