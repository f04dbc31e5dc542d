# Run by the installation. Python compiled the messages' modules where they were built, and wrote that place into what it made;
# at their first use it compiles them again.
foreach(part . msg srv)
  file(REMOVE_RECURSE "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${python_modules}/${part}/__pycache__")
endforeach()
