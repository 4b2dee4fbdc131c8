# Run by cpack: makes the folders of the package readable for all. Those that an installation creates lose what the
# umask takes, with CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS too.

file(CHMOD_RECURSE ${CPACK_TEMPORARY_INSTALL_DIRECTORY} DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
     GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
