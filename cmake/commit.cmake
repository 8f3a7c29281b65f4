# Writes FILE, a header with the commit the program is made from, when it has changed. Run at each build.
execute_process(COMMAND git describe --always --dirty=+ --exclude=* WORKING_DIRECTORY ${ROOT}
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(WRITE ${FILE}.new "#define TRACKBED_COMMIT \"${commit}\"\n")
execute_process(COMMAND ${CMAKE_COMMAND} -E copy_if_different ${FILE}.new ${FILE})
