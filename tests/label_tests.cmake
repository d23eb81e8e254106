# SPDX-License-Identifier: Apache-2.0
# CTest reads this file after it has listed the tests of a folder's GoogleTest executables. It gives each the label "quick"
# or "slow". suites: the executables; slow: names of suites of slow.txt.
foreach(suite IN LISTS suites)
  foreach(test IN LISTS ${suite}_TESTS)
    string(REGEX REPLACE "[.].*" "" name "${test}")
    list(FIND slow "${name}" index)
    if(index GREATER -1)
      set_tests_properties("${test}" PROPERTIES LABELS slow)
    else()
      set_tests_properties("${test}" PROPERTIES LABELS quick)
    endif()
  endforeach()
endforeach()
