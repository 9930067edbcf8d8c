# Writes the header with the commit of the source tree; leaves it alone if nothing has changed.
# cmake -DGIT=<program or empty> -DSOURCE=<clone> -DHEADER=<file> -P build_commit.cmake
set(commit "")
if(GIT AND EXISTS ${SOURCE}/.git)
  # The clone may belong to someone else (a container, sudo).
  execute_process(COMMAND ${GIT} -c safe.directory=${SOURCE} -C ${SOURCE} describe --always --dirty --abbrev=40 --exclude=*
                  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
if(NOT commit)
  set(commit unknown)
endif()
set(text "#pragma once\n#define MULDI_BUILD_COMMIT \"${commit}\"\n")
if(EXISTS ${HEADER})
  file(READ ${HEADER} before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE ${HEADER} "${text}")
endif()
