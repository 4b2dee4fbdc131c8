# Run by cmake --install: the unit WEIR_UNIT, written for /usr, for the prefix there is; WEIR_UNIT_COPY is where it is kept.

file(READ ${WEIR_UNIT} unit)
string(REPLACE "/usr/" "${CMAKE_INSTALL_PREFIX}/" unit "${unit}")
file(WRITE ${WEIR_UNIT_COPY} "${unit}")
file(INSTALL ${WEIR_UNIT_COPY} DESTINATION ${CMAKE_INSTALL_PREFIX}/lib/systemd/system)
