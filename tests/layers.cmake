# Checks who includes whom. Usage: cmake -D ROOT=<repository> -P tests/layers.cmake
# Prints file:line of each breach, then fails.

cmake_minimum_required(VERSION 3.25)

# ---- The plan -------------------------------------------------------------------------------------------------------

# Rooms of renderer/ by floor. A file includes its own room and the floors below, no other room of its own floor.
set(floor_9 experiments)
set(floor_8 engine)
set(floor_7 integrators)
set(floor_6 march)
set(floor_5 scene scene_io)
set(floor_4 media lights phase surfaces camera)
set(floor_3 geometry film analysis)
set(floor_2 sampling)
set(floor_1 params)
set(floor_0 core)
set(same_floor_exceptions "scene_io->scene" "analysis->film")

# Third-party headers that stay behind a type of ours: pattern of the include, pattern of the files that may.
set(fences
  "openvdb/"   "^renderer/media/vdb_file\\.cpp$"
  "embree"     "^renderer/geometry/[^/]+\\.cpp$"
  "tiny_obj"   "^renderer/geometry/mesh_file\\.cpp$"
  "nanovdb/"   "^renderer/media/.*\\.cpp$"
  "nlohmann/"  "^(renderer/scene_io/.*\\.cpp|app/cli/.*\\.cpp|renderer/(.*/)?[^/]*json[^/]*\\.cpp)$")

# renderer/ knows no window and no widget.
set(window_headers "^(GL/|GLES|EGL/|GLFW/|imgui|CLI/)")

set(top_level CMakeLists.txt CMakePresets.json CMakeUserPresets.json LICENSE README.md
  app build renderer scenes tests third_party)

# ---- The check ------------------------------------------------------------------------------------------------------

set(breaches 0)
macro(breach place text)
  message("${place}: ${text}")
  math(EXPR breaches "${breaches} + 1")
endmacro()

# Each "path:line:text" that the extended regular expression finds in the C++ files of the folders.
function(grep_lines result pattern)
  set(folders "")
  foreach(folder IN LISTS ARGN)
    if(IS_DIRECTORY "${ROOT}/${folder}")
      list(APPEND folders ${folder})
    endif()
  endforeach()
  set(output "")
  if(folders)
    execute_process(COMMAND grep -rnE --include=*.h --include=*.cpp -e "${pattern}" ${folders}
      WORKING_DIRECTORY "${ROOT}" OUTPUT_VARIABLE output RESULT_VARIABLE status)
    if(status GREATER 1)
      message(FATAL_ERROR "grep failed")
    endif()
  endif()
  string(REGEX REPLACE "[][;\\]" " " output "${output}")  # what CMake's lists trip over; no include has these
  string(REGEX REPLACE "\n+$" "" output "${output}")
  string(REPLACE "\n" ";" output "${output}")
  set(${result} "${output}" PARENT_SCOPE)
endfunction()

foreach(floor RANGE 9)
  foreach(room IN LISTS floor_${floor})
    set(floor_of_${room} ${floor})
  endforeach()
endforeach()

grep_lines(includes "^[[:space:]]*#[[:space:]]*include" renderer app)
set(embree_files "")
foreach(line IN LISTS includes)
  if(NOT line MATCHES "^([^:]+):([0-9]+):[ \t]*#[ \t]*include[ \t]*([<\"])([^>\"]+)")
    continue()  # an include of a macro, such as Highway's HWY_TARGET_INCLUDE
  endif()
  set(file "${CMAKE_MATCH_1}")
  set(place "${CMAKE_MATCH_1}:${CMAKE_MATCH_2}")
  set(bracket "${CMAKE_MATCH_3}")
  set(header "${CMAKE_MATCH_4}")

  if(bracket STREQUAL "\"" AND NOT header MATCHES "^(renderer|app|hwy|third_party)/")
    breach("${place}"
      "\"${header}\" is not named from the repository root (\"renderer/core/vec.h\"); libraries take <>")
  endif()

  set(rest "${fences}")
  while(rest)
    list(POP_FRONT rest fenced allowed)
    if(header MATCHES "^${fenced}" AND NOT file MATCHES "${allowed}")
      string(REGEX REPLACE "^\\^|\\$$|\\\\" "" readable "${allowed}")
      breach("${place}" "<${header}> is allowed only in ${readable}")
    endif()
  endwhile()
  if(header MATCHES "^embree" AND NOT file IN_LIST embree_files)
    list(APPEND embree_files "${file}")
    list(LENGTH embree_files count)
    if(count GREATER 1)
      breach("${place}" "<${header}> is already included by another file; Embree stays in one")
    endif()
  endif()

  if(NOT file MATCHES "^renderer/")
    continue()
  endif()
  if(header MATCHES "^app/")
    breach("${place}" "renderer/ must not include app/ (\"${header}\")")
  endif()
  if(header MATCHES "${window_headers}")
    breach("${place}" "renderer/ must not include a window, widget or command-line library (<${header}>)")
  endif()

  if(NOT file MATCHES "^renderer/([^/]+)/")
    breach("${place}" "a source of renderer/ lies in a room, not beside them")
    continue()
  endif()
  set(from "${CMAKE_MATCH_1}")
  if(NOT DEFINED floor_of_${from})
    breach("${place}" "renderer/${from} has no floor: give it one in tests/layers.cmake")
    continue()
  endif()
  if(NOT header MATCHES "^renderer/([^/]+)/")
    continue()
  endif()
  set(to "${CMAKE_MATCH_1}")
  if(from STREQUAL to OR "${from}->${to}" IN_LIST same_floor_exceptions)
    continue()
  elseif(NOT DEFINED floor_of_${to})
    breach("${place}" "renderer/${to} has no floor: give it one in tests/layers.cmake")
  elseif(floor_of_${to} EQUAL floor_of_${from})
    breach("${place}" "${from} and ${to} share floor ${floor_of_${from}}, so neither includes the other")
  elseif(floor_of_${to} GREATER floor_of_${from})
    breach("${place}" "${from} (floor ${floor_of_${from}}) must not include ${to} (floor ${floor_of_${to}})")
  endif()
endforeach()

# The renderer never prints: messages go to a sink that the application sets. snprintf into a buffer is fine.
set(print_calls "std::(cout|cerr|clog)|(^|[^a-zA-Z0-9_])(v?f?printf|f?puts|putchar|perror) *\\(")
grep_lines(prints "${print_calls}" renderer)
foreach(line IN LISTS prints)
  if(line MATCHES "^([^:]+):([0-9]+):(.*)$" AND NOT CMAKE_MATCH_1 STREQUAL "renderer/core/check.h")
    set(place "${CMAKE_MATCH_1}:${CMAKE_MATCH_2}")
    string(REGEX REPLACE "//.*$" "" code "${CMAKE_MATCH_3}")
    if(code MATCHES "${print_calls}")
      breach("${place}" "the renderer never prints; send the message to the log sink")
    endif()
  endif()
endforeach()

# Dot-files and dot-folders are free; generated things belong in build/.
file(GLOB entries RELATIVE "${ROOT}" "${ROOT}/*")
foreach(entry IN LISTS entries)
  if(NOT entry MATCHES "^\\." AND NOT entry IN_LIST top_level)
    list(JOIN top_level " " names)
    breach("${entry}:1" "the top level holds only ${names}")
  endif()
endforeach()

if(breaches)
  message(FATAL_ERROR "Breaches of the floor plan: ${breaches}")
endif()
list(LENGTH includes count)
message("${count} includes follow the floor plan")
