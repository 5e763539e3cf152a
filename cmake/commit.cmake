# Writes the commit of the working tree and whether it is dirty into OUTPUT, from OUTPUT.in. Run by every build, because a
# commit changes without CMake noticing; the file keeps its time stamp while its text stays the same, so that nothing is rebuilt
# then.
#
#   cmake -D SOURCE=FOLDER -D OUTPUT=FILE -P commit.cmake

set(commit unknown)
set(dirty false)

find_program(git git)
if(git)
  # A release unpacked inside somebody else's repository is not at that repository's commit: the prefix, which is the
  # way from the top of the repository to SOURCE, must be empty.
  execute_process(COMMAND ${git} rev-parse --show-prefix WORKING_DIRECTORY ${SOURCE}
    RESULT_VARIABLE failed OUTPUT_VARIABLE prefix OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed AND prefix STREQUAL "")
    execute_process(COMMAND ${git} rev-parse --verify HEAD WORKING_DIRECTORY ${SOURCE}
      RESULT_VARIABLE failed OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(NOT failed)
      set(commit ${head})
      # Only what the program is made of counts: results and notes lying about don't make its numbers less reproducible.
      # An untracked source file does, since the build picks it up.
      execute_process(
        COMMAND ${git} --no-optional-locks status --porcelain -- CMakeLists.txt CMakePresets.json cmake src kernels scenes
        WORKING_DIRECTORY ${SOURCE} RESULT_VARIABLE failed OUTPUT_VARIABLE changes)
      if(failed OR NOT changes STREQUAL "")
        set(dirty true)
      endif()
    endif()
  endif()
endif()

configure_file(${OUTPUT}.in ${OUTPUT} @ONLY)
