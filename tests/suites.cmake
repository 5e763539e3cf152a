# Read by ctest, with $program, the filters of labels and, where the program is of another machine, the $emulator that runs it: makes one
# test of each GoogleTest suite, named as it, which runs the suite's cases in one process. To start a process takes 27 ms of a processor
# (an emulator 0.6 s), which nearly 3,000 cases would each pay, and cases of a suite share what one of them has made. One case alone:
# bin/mssim_tests --gtest_filter=SUITE.CASE

# add_suites(FILTER SUFFIX LABEL): the cases that the filter lets through; where that is a part of a suite, the test's name
# must differ from that of the rest.
function(add_suites filter suffix label)
  execute_process(COMMAND ${emulator} ${program} --gtest_list_tests --gtest_filter=${filter} OUTPUT_VARIABLE listing
    COMMAND_ERROR_IS_FATAL ANY)
  # "SUITE." at the start of a line, "  CASE" below it, either before a comment.
  string(REGEX MATCHALL "\n *[A-Za-z0-9_/]+\\.?" lines "\n${listing}")
  foreach(line ${lines})
    string(STRIP ${line} name)
    if(name MATCHES "\\.$")
      set(suite ${name})
      list(APPEND suites ${suite})
    elseif(line MATCHES "^\n  ")
      string(APPEND cases_of_${suite} ":${suite}${name}")
    endif()
  endforeach()
  foreach(suite ${suites})
    string(SUBSTRING "${cases_of_${suite}}" 1 -1 cases)
    string(REGEX REPLACE "\\.$" "${suffix}" name ${suite})
    add_test(${name} ${emulator} ${program} --gtest_filter=${cases})
    set_tests_properties(${name} PROPERTIES LABELS "${label}" TIMEOUT 3600)
  endforeach()
endfunction()

if(EXISTS ${program})
  add_suites("-${kernel_tests}:${signal_tests}:${waiting_tests}" "" "")
  add_suites("${kernel_tests}" .kernels kernels)
  add_suites("${signal_tests}" .signals signals)
  add_suites("${waiting_tests}" .waits waits)
else()
  add_test(mssim_tests_NOT_BUILT mssim_tests_NOT_BUILT)
endif()
