# Run by cmake --install: the unit WEIR_UNIT, written for /usr, made to fit the prefix there is, and WEIR_EXAMPLE.

set(folder ${CMAKE_INSTALL_PREFIX}/lib/systemd/system)
file(INSTALL ${WEIR_UNIT} DESTINATION ${folder})
get_filename_component(name ${WEIR_UNIT} NAME)
file(READ ${WEIR_UNIT} unit)
string(REPLACE "/usr/" "${CMAKE_INSTALL_PREFIX}/" unit "${unit}")
file(WRITE $ENV{DESTDIR}${folder}/${name} "${unit}")

# The configuration to start from: in /etc/weir, where the unit looks for configurations, beside /usr; elsewhere below the
# prefix, in PREFIX/etc/weir, from where it is to be copied.
get_filename_component(etc ${CMAKE_INSTALL_PREFIX}/etc ABSOLUTE)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(etc /etc)
endif()
file(INSTALL ${WEIR_EXAMPLE} DESTINATION ${etc}/weir)
