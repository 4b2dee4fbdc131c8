# cmake -D WEIR=<command> -D OUTPUT=<folder> -P write_share.cmake
# Has the command write its manual, OUTPUT/man/*.1.gz and *.5.gz, and OUTPUT/weir.SHELL, its completion for three shells.

file(REMOVE_RECURSE ${OUTPUT})
file(MAKE_DIRECTORY ${OUTPUT}/man)
execute_process(COMMAND ${WEIR} man ${OUTPUT}/man COMMAND_ERROR_IS_FATAL ANY)
file(GLOB pages ${OUTPUT}/man/*.1 ${OUTPUT}/man/*.5)
execute_process(COMMAND gzip -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
foreach(shell zsh fish bash)
  execute_process(COMMAND ${WEIR} completion ${shell} OUTPUT_FILE ${OUTPUT}/weir.${shell} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
