# What cmake --install brings: the command with all that belongs to it, and what other programs embed.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME weir)

# weir_install_libraries(): weir::format_core, weir::gpu_core and, where it is built, weir::cuda, with their headers, for
# find_package(weir).
function(weir_install_libraries)
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/weir)
  set(headers ${CMAKE_INSTALL_INCLUDEDIR}/weir)
  install(TARGETS weir_options weir_format_core weir_gpu_core EXPORT weirTargets FILE_SET HEADERS DESTINATION ${headers})
  install(EXPORT weirTargets NAMESPACE weir:: DESTINATION ${package})
  if(TARGET weir_cuda)  # of its own, since it needs the CUDA toolkit where it is used
    install(TARGETS weir_cuda EXPORT weirCudaTargets FILE_SET HEADERS DESTINATION ${headers})
    install(EXPORT weirCudaTargets NAMESPACE weir:: DESTINATION ${package})
  endif()
  # Headers may change with the second number while the first is 0.
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/weirConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/weirConfig.cmake ${CMAKE_BINARY_DIR}/weirConfigVersion.cmake
          DESTINATION ${package})
endfunction()

# weir_install_command(): the command, its manual, shell completion, service and documents. The target weir_share makes
# what is written by the command itself.
function(weir_install_command)
  set(source ${PROJECT_SOURCE_DIR})
  set(share ${CMAKE_BINARY_DIR}/share)
  set(script ${source}/cmake/write_share.cmake)
  add_custom_command(OUTPUT ${share}/weir.bash
                     COMMAND ${CMAKE_COMMAND} -D WEIR=$<TARGET_FILE:weir> -D OUTPUT=${share} -P ${script}
                     DEPENDS weir ${script} COMMENT "Writing the manual and shell completion" VERBATIM)
  add_custom_target(weir_share ALL DEPENDS ${share}/weir.bash)

  install(TARGETS weir RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${share}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN *.1.gz)
  install(DIRECTORY ${share}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man5 FILES_MATCHING PATTERN *.5.gz)
  install(FILES ${share}/weir.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME weir)
  install(FILES ${share}/weir.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _weir)
  install(FILES ${share}/weir.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
  if(WEIR_DAEMON)
    install(CODE "set(WEIR_UNIT \"${source}/daemon/weir@.service\")\nset(WEIR_EXAMPLE \"${source}/daemon/example.toml\")")
    install(SCRIPT ${source}/cmake/install_unit.cmake)
    install(FILES ${source}/daemon/sysusers.conf DESTINATION lib/sysusers.d RENAME weir.conf)
  endif()
  install(FILES ${source}/format/sidecar.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/weir)

  # The documents as they lie in the sources, so that their links lead somewhere.
  install(FILES ${source}/README.md ${source}/CHANGELOG.md ${source}/CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
  install(FILES ${source}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT license)
  install(FILES ${source}/format/FORMAT.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/format)
  install(FILES ${source}/format/sidecar.schema.json DESTINATION ${CMAKE_INSTALL_DOCDIR}/format)
  install(DIRECTORY ${source}/docs ${source}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
endfunction()
