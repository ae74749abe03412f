# SPDX-License-Identifier: BSL-1.0
# usage: cmake -DOUT=FILE.cpp "-DFILES=A.cpp;B.cpp" -P together.cmake
# One source in place of several tests: what they include is read once and instantiated once. Each test stands in
# a namespace of its own, so that two may have helpers of one name; their includes come before, because none may be
# read inside a namespace (a second time #pragma once leaves nothing of them).
cmake_minimum_required(VERSION 3.24)
set(includes)
set(tests)
foreach(file IN LISTS FILES)
  get_filename_component(folder ${file} DIRECTORY)
  get_filename_component(name ${file} NAME_WE)
  file(STRINGS ${file} lines REGEX "^[ \t]*#[ \t]*include")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*([<\"][^>\"]+[>\"]).*" "\\1" header "${line}")
    string(REGEX REPLACE "^\"(.*)\"$" "${folder}/\\1" beside "${header}")
    if(EXISTS "${beside}")
      set(header "\"${beside}\"")
    endif()
    list(APPEND includes "#include ${header}")
  endforeach()
  string(APPEND tests "namespace test_${name} {\n#include \"${file}\"\n}\n")
endforeach()
list(REMOVE_DUPLICATES includes)
list(JOIN includes "\n" includes)
file(CONFIGURE OUTPUT ${OUT} CONTENT "@includes@\n\n@tests@" @ONLY)
