# Run by CTest when it starts: asks one GoogleTest program for its suites and registers each as a test.
#
# In: name ("unit"), program, working_dir, environment (list of NAME=value), timeout (seconds),
#     xvfb_run (may be NOTFOUND), cmake.

cmake_minimum_required(VERSION 3.25)  # CTest starts without policies

if("$ENV{BRUME_TEST_FULL}" STREQUAL "1")
  math(EXPR timeout "12 * ${timeout}")  # the references alone take an hour and a half of two cores
endif()

# brume_register(<test name> <label> <command>...)
macro(brume_register test label)
  add_test("${test}" ${ARGN})
  set_tests_properties("${test}" PROPERTIES
    LABELS "${label}" ENVIRONMENT "${environment}" WORKING_DIRECTORY "${working_dir}" TIMEOUT ${timeout}
    ENVIRONMENT_MODIFICATION "DISPLAY=unset:;WAYLAND_DISPLAY=unset:"
    # The closing lines of a suite in which every test was skipped; a failure would stand after them.
    SKIP_REGULAR_EXPRESSION "  PASSED  . 0 tests.\n(.  SKIPPED . [^\n]*\n)+\n*$")
endmacro()

if(NOT EXISTS "${program}")
  brume_register("${name}.NOT_BUILT" ${name} "${program}")  # fails, and says which program is missing
  return()
endif()
execute_process(
  COMMAND "${cmake}" -E env ${environment} "${program}" --gtest_list_tests
  WORKING_DIRECTORY "${working_dir}" OUTPUT_VARIABLE listing ERROR_VARIABLE complaint RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  brume_register("${name}.LISTING_FAILED" ${name} sh -c "\"$0\" --gtest_list_tests; exit 1" "${program}")
  return()
endif()

# Lines are "Suite." or "Prefix/Suite.  # comment", each followed by its tests, which are indented.
string(REGEX REPLACE "[][;\\]" "_" listing "${listing}")  # comments may hold what CMake's lists trip over
string(REPLACE "\n" ";" listing "${listing}")
set(suites "")
set(suite "")
set(real_window FALSE)
foreach(line IN LISTS listing)
  if(line MATCHES "^([^ #]+)\\.( |$)")
    set(suite "${CMAKE_MATCH_1}")
    continue()
  elseif(NOT suite OR NOT line MATCHES "^  ([^ #]+)")
    continue()
  endif()
  set(test "${suite}.${CMAKE_MATCH_1}")
  if(test MATCHES "(^|[./])DISABLED_")
    continue()
  elseif(test MATCHES "RealWindow")
    set(real_window TRUE)
    continue()
  endif()
  if(NOT suite IN_LIST suites)
    list(APPEND suites "${suite}")
    set(label_${suite} ${name})
    set(alone_${suite} FALSE)
  endif()
  if(test MATCHES "Snapshot")
    set(label_${suite} "${name};snapshot")
  endif()
  if(test MATCHES "Timing")
    set(alone_${suite} TRUE)
  endif()
endforeach()

foreach(suite IN LISTS suites)
  brume_register("${name}.${suite}" "${label_${suite}}" "${program}" "--gtest_filter=${suite}.*:-*RealWindow*")
  set_tests_properties("${name}.${suite}" PROPERTIES RUN_SERIAL ${alone_${suite}})
endforeach()

if(real_window)
  if(NOT xvfb_run)
    set(xvfb_run xvfb-run)  # fails, and says that it is missing
  endif()
  brume_register(real_window "${name}" "${xvfb_run}" -a -s "-screen 0 1400x900x24"
    "${program}" "--gtest_filter=*RealWindow*")
  set_tests_properties(real_window PROPERTIES RUN_SERIAL TRUE)
endif()
