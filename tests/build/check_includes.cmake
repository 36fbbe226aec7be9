# cmake -D tree=DIR -P check_includes.cmake: fails, with one line a fault, where the sources in DIR break the rules:
#   a room includes itself and rooms to its left only;
#   a public header includes the standard library, Eigen, Boost.Multiprecision and public headers only;
#   the headers of one solver or tool are included by one .cpp.
cmake_policy(VERSION 3.25)

set(rooms wave orbit program study report app)

set(tools ipopt nlopt clp sqlite mpi toml cli)
set(tool_ipopt "^(coin/|coin-or/)?Ip[A-Z][A-Za-z]*\\.hpp$")
set(tool_nlopt "^nlopt\\.(h|hpp)$")
set(tool_clp "^(coin/|coin-or/)?(Clp|Coin|Osi)[A-Za-z_]*\\.(h|hpp)$")
set(tool_sqlite "^(SQLiteCpp/.*|sqlite3\\.h)$")
set(tool_mpi "^mpi\\.h$")
set(tool_toml "^toml(\\+\\+|plusplus)?(/.*|\\.h|\\.hpp)$")
set(tool_cli "^CLI/.*$")

set(faults 0)
macro(fault text)
  math(EXPR faults "${faults} + 1")
  message("${text}")
endmacro()

file(GLOB_RECURSE files RELATIVE ${tree}
     ${tree}/include/*.h ${tree}/include/*.hpp ${tree}/src/*.h ${tree}/src/*.hpp ${tree}/src/*.cpp)
list(LENGTH files count)
if(count EQUAL 0)
  message(FATAL_ERROR "no source under ${tree}")
endif()

foreach(file IN LISTS files)
  if(NOT file MATCHES "^(include/nsma|src)/([a-z]+)/" OR NOT CMAKE_MATCH_2 IN_LIST rooms)
    fault("${file}: in no room")
    continue()
  endif()
  set(room ${CMAKE_MATCH_2})
  list(FIND rooms ${room} place)
  string(FIND ${file} "include/" at)
  if(at EQUAL 0)
    set(public TRUE)
  else()
    set(public FALSE)
  endif()

  file(STRINGS ${tree}/${file} lines REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]*).*" "\\1" header "${line}")

    foreach(other IN LISTS rooms)
      list(FIND rooms ${other} other_place)
      if("/${header}" MATCHES "/${other}/" AND other_place GREATER place)
        fault("${file}: the room ${room} may not know ${other} (${header})")
      endif()
    endforeach()

    if(public AND NOT header MATCHES "^([a-z_0-9]+|Eigen/.+|boost/multiprecision/.+|nsma/.+)$")
      fault("${file}: a public header may not include ${header}")
    endif()

    foreach(tool IN LISTS tools)
      if(header MATCHES "${tool_${tool}}")
        if(file MATCHES "\\.cpp$")
          list(APPEND users_of_${tool} ${file})
        else()
          fault("${file}: only one .cpp may include ${header}")
        endif()
      endif()
    endforeach()
  endforeach()
endforeach()

foreach(tool IN LISTS tools)
  list(REMOVE_DUPLICATES users_of_${tool})
  list(LENGTH users_of_${tool} users)
  if(users GREATER 1)
    fault("${users_of_${tool}}: only one .cpp may include headers of ${tool}")
  endif()
endforeach()

if(faults GREATER 0)
  message(FATAL_ERROR "${faults} forbidden includes")
endif()
message("${count} files, no forbidden include")
