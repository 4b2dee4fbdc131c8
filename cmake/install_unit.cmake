# Run by cmake --install: the unit WEIR_UNIT, written for /usr, made to fit the prefix there is.

set(folder ${CMAKE_INSTALL_PREFIX}/lib/systemd/system)
file(INSTALL ${WEIR_UNIT} DESTINATION ${folder})
get_filename_component(name ${WEIR_UNIT} NAME)
file(READ ${WEIR_UNIT} unit)
string(REPLACE "/usr/" "${CMAKE_INSTALL_PREFIX}/" unit "${unit}")
file(WRITE $ENV{DESTDIR}${folder}/${name} "${unit}")
